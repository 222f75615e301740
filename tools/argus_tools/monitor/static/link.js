// SPDX-License-Identifier: MIT
// The websocket: says the secret, hands on what comes, opens again what was lost, and asks with replies.

const NO_TOKEN = 4401;
const TOO_MANY = 4429;
const PAUSES_MS = [250, 500, 1000, 2000];
const REPLY_WITHIN_MS = 8000;
const BEAT_MS = 500;
const SILENT_MS = 1500;
const CLOCKS_KEPT = 20;
const KEY = "argus-monitor-token";

/** The secret: of the address, which then loses it, or the one kept for this tab. */
function tokenOf() {
  const given = decodeURIComponent(location.hash.slice(1));
  if (/^[!-~]{16,128}$/.test(given)) {
    sessionStorage.setItem(KEY, given);
    history.replaceState(null, "", location.pathname);
  }
  return sessionStorage.getItem(KEY) ?? "";
}

export class Link {
  /** told(message) gets what is no reply; up(text) hears of the connection, "" when it stands; wanted() asks for the secret. */
  constructor(told, up, wanted) {
    Object.assign(this, { told, up, wanted, socket: null, asked: new Map(), last: 0, attempt: 0, heardAt: 0, clocks: [] });
    setInterval(() => this.#beat(), BEAT_MS);
  }

  /** The server's clock, ms since 1970: this machine's may be an hour off. NaN until it is known. */
  now() {
    const best = this.clocks.reduce((a, b) => (b.trip < a.trip ? b : a), { trip: Infinity, ahead: NaN });
    return performance.now() + best.ahead;
  }

  open() {
    const token = tokenOf();
    if (!token) {
      this.wanted();
      return;
    }
    const place = new URL("live", document.baseURI); // beside the page, wherever a proxy has put it
    place.protocol = place.protocol.replace("http", "ws");
    place.hash = "";
    const socket = new WebSocket(place);
    this.socket = socket;
    this.clocks = [];
    this.heardAt = performance.now();
    const ours = (does) => (event) => this.socket === socket && does(event);
    socket.addEventListener("open", ours(() => socket.send(JSON.stringify({ token }))));
    socket.addEventListener("message", ours((event) => this.#take(JSON.parse(event.data))));
    socket.addEventListener("close", ours((event) => this.#closed(event.code)));
  }

  /** Ask for the time, so that something is heard; a connection that carries nothing is left and opened again. */
  async #beat() {
    const { socket } = this;
    if (!socket) return;
    const asked = performance.now();
    if (asked - this.heardAt > SILENT_MS) {
      this.#closed(0); // first: from a dead peer its own close may take minutes
      socket.close();
      return;
    }
    if (socket.readyState !== WebSocket.OPEN) return;
    const answer = await this.ask({ do: "clock" });
    if (this.socket !== socket || typeof answer.unix !== "number") return;
    const trip = performance.now() - asked;
    this.clocks.push({ trip, ahead: answer.unix * 1000 - asked - trip / 2 });
    if (this.clocks.length > CLOCKS_KEPT) this.clocks.shift();
  }

  use(token) {
    sessionStorage.setItem(KEY, token.trim().replace(/^.*#/, ""));
    this.open();
  }

  #take(message) {
    this.attempt = 0;
    this.heardAt = performance.now();
    const waiting = "re" in message ? this.asked.get(message.re) : undefined;
    if (waiting) {
      this.asked.delete(message.re);
      waiting(message);
    } else if (!("re" in message)) {
      this.told(message);
    }
  }

  #closed(code) {
    for (const waiting of this.asked.values()) waiting({ ok: false, say: "The connection was lost." });
    this.asked.clear();
    this.socket = null;
    if (code === NO_TOKEN) {
      sessionStorage.removeItem(KEY);
      this.up("the secret was refused");
      this.wanted();
      return;
    }
    this.up(code === TOO_MANY ? "too many viewers" : "argus-monitor is away");
    setTimeout(() => this.open(), PAUSES_MS[Math.min(this.attempt++, PAUSES_MS.length - 1)]);
  }

  /** Ask, and resolve with the reply; never rejects. */
  ask(request) {
    if (this.socket?.readyState !== WebSocket.OPEN) return Promise.resolve({ ok: false, say: "There is no connection." });
    const id = ++this.last;
    return new Promise((resolve) => {
      this.asked.set(id, resolve);
      setTimeout(() => this.asked.delete(id) && resolve({ ok: false, say: "No answer came." }), REPLY_WITHIN_MS);
      this.socket.send(JSON.stringify({ ...request, id }));
    });
  }
}
