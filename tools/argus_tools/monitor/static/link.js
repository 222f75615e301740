// SPDX-License-Identifier: MIT
// The websocket: says the secret, hands on what comes, opens again what was lost, and asks with replies.

const NO_TOKEN = 4401;
const TOO_MANY = 4429;
const PAUSES_MS = [250, 500, 1000, 2000];
const REPLY_WITHIN_MS = 8000;
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
    Object.assign(this, { told, up, wanted, socket: null, asked: new Map(), last: 0, attempt: 0 });
  }

  open() {
    const token = tokenOf();
    if (!token) {
      this.wanted();
      return;
    }
    const socket = new WebSocket(`ws://${location.host}/live`);
    this.socket = socket;
    socket.addEventListener("open", () => socket.send(JSON.stringify({ token })));
    socket.addEventListener("message", (event) => this.#take(JSON.parse(event.data)));
    socket.addEventListener("close", (event) => this.#closed(event.code));
  }

  use(token) {
    sessionStorage.setItem(KEY, token.trim().replace(/^.*#/, ""));
    this.open();
  }

  #take(message) {
    this.attempt = 0;
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
