# SPDX-License-Identifier: MIT
"""Link over CAN: one ARCOS packet per ISO-TP message, through the kernel's sockets or a stack in user space."""

from __future__ import annotations

import errno
import logging
import os
import socket
import time
from abc import ABC, abstractmethod
from collections import Counter, deque
from collections.abc import Callable, Iterable
from typing import Any, Final

import isotp

from hil_sim.arcos import FRAME
from hil_sim.errors import LinkError
from hil_sim.links.base import BACKLOG_MS, Link
from hil_sim.links.can_spec import ID_MAX, CanSpec
from hil_sim.links.root import as_root

PACKET_MAX: Final = FRAME["COUNT_MAX"] + FRAME["OVERHEAD"]
PDU_MAX: Final = 4095

_REOPEN_MS: Final = 250.0
_USER_STEP_MS: Final = 1.0
"""A stack in user space that is sending is looked after this often."""
_BIT_RATE_SWITCH: Final = 1
_HEADER: Final = bytes((FRAME["HEADER0"], FRAME["HEADER1"]))
_CLASSIC_MTU: Final = 16
_GONE: Final = (errno.ENXIO, errno.ENODEV, errno.EADDRNOTAVAIL)
_NO_CAN: Final = (errno.EAFNOSUPPORT, errno.EPROTONOSUPPORT, errno.ESOCKTNOSUPPORT)

_log = logging.getLogger("argus.sim.can")


def is_packet(pdu: bytes) -> bool:
    """The message is one ARCOS packet by its header and length; its checksum is for the server to judge."""
    return len(pdu) > len(_HEADER) and pdu.startswith(_HEADER) and len(pdu) == pdu[2] + FRAME["OVERHEAD"]


class Fault(Exception):
    """Something went wrong on the bus; `name` is what it is counted under."""

    def __init__(self, name: str, number: int = 0) -> None:
        super().__init__(name)
        self.name = name
        self.number = number


def _fault(error: OSError) -> Fault:
    number = error.errno or 0
    return Fault(errno.errorcode.get(number, str(error)), number)


class Stack(ABC):
    """One end of an ISO-TP connection. Every method returns at once; what goes wrong is a `Fault`."""

    @abstractmethod
    def send(self, packet: bytes) -> bool:
        """Begin to send a message; False while another one is on its way."""

    @abstractmethod
    def receive(self) -> bytes | None:
        """Return a message, or None."""

    @abstractmethod
    def fileno(self) -> int:
        """What becomes readable when there is something to do."""

    def due_ms(self, now_ms: float) -> float | None:  # noqa: ARG002 (only a stack in user space needs to be called)
        """When it is to be called though nothing arrives."""
        return None

    @abstractmethod
    def close(self) -> None:
        """Release everything."""


class KernelStack(Stack):
    """The kernel's ISO-TP socket."""

    def __init__(self, spec: CanSpec) -> None:
        try:
            self._isotp = isotp.socket()
        except OSError as error:
            raise _fault(error) from error
        self._socket = self._isotp.real_socket()
        self._socket.setblocking(False)
        self._isotp.set_opts(txpad=spec.pad)
        self._isotp.set_fc_opts(stmin=spec.stmin, bs=spec.bs)
        try:
            if spec.fd:
                self._isotp.set_ll_opts(
                    mtu=isotp.socket.LinkLayerProtocol.CAN_FD, tx_dl=64, tx_flags=_BIT_RATE_SWITCH
                )
            self._isotp.bind(spec.interface, _address(spec))
        except OSError as error:
            self.close()
            raise _fault(error) from error

    def send(self, packet: bytes) -> bool:
        """Give the kernel a message; it reports what becomes of it with the next `receive`."""
        try:
            self._socket.send(packet)
        except BlockingIOError:
            return False
        except OSError as error:
            raise _fault(error) from error
        return True

    def receive(self) -> bytes | None:
        """Return a message, or the error that the kernel has noted."""
        try:
            return self._socket.recv(PDU_MAX + 1)
        except (BlockingIOError, InterruptedError):
            return None
        except OSError as error:
            raise _fault(error) from error

    def fileno(self) -> int:
        """The socket."""
        return self._socket.fileno()

    def close(self) -> None:
        """Close the socket; the kernel may take a second when a message is under way."""
        self._isotp.close()


class UserStack(Stack):
    """can-isotp's own state machine over python-can: for a kernel without ISO-TP, and to check the kernel's."""

    def __init__(self, spec: CanSpec) -> None:
        import can

        logging.getLogger("isotp").setLevel(logging.CRITICAL)  # errors are counted here, and said once
        self._can_error = can.CanError
        self._faults: deque[str] = deque()
        try:
            self._bus = can.Bus(
                channel=spec.interface,
                interface="socketcan",
                fd=spec.fd,
                can_filters=[{"can_id": spec.rx_id, "can_mask": ID_MAX, "extended": False}],
            )
        except OSError as error:
            raise _fault(error) from error
        except can.CanError as error:
            raise Fault(str(error), getattr(error, "error_code", 0) or 0) from error
        self._stack = isotp.CanStack(
            bus=self._bus,
            address=_address(spec),
            error_handler=lambda error: self._faults.append(type(error).__name__),
            params={
                "stmin": spec.stmin,
                "blocksize": spec.bs,
                "tx_padding": spec.pad,
                "tx_data_min_length": None if spec.pad is None else 8,  # as the kernel pads
                "tx_data_length": 64 if spec.fd else 8,
                "can_fd": spec.fd,
                "bitrate_switch": spec.fd,
                "max_frame_size": PDU_MAX,
            },
        )

    def _process(self) -> None:
        try:
            self._stack.process()
        except (self._can_error, OSError) as error:
            # What was being sent is lost; it would wait for a flow control that cannot come.
            self._stack.stop_sending()
            number = getattr(error, "error_code", 0) or getattr(error, "errno", 0) or 0
            raise Fault(errno.errorcode.get(number, type(error).__name__), number) from error

    def send(self, packet: bytes) -> bool:
        """Begin to send."""
        if self._stack.transmitting():
            self._process()
            return False
        self._stack.send(packet)
        self._process()
        return True

    def receive(self) -> bytes | None:
        """Do what is due; return a message."""
        self._process()
        if self._faults:
            raise Fault(self._faults.popleft())
        pdu = self._stack.recv()
        return None if pdu is None else bytes(pdu)

    def fileno(self) -> int:
        """The raw socket."""
        return int(self._bus.fileno())

    def due_ms(self, now_ms: float) -> float | None:
        """Soon, while a message is on its way."""
        return now_ms + _USER_STEP_MS if self._stack.transmitting() else None

    def close(self) -> None:
        """Close the bus."""
        self._bus.shutdown()


def _address(spec: CanSpec) -> isotp.Address:
    return isotp.Address(isotp.AddressingMode.Normal_11bits, rxid=spec.rx_id, txid=spec.tx_id)


def _mtu(interface: str) -> int | None:
    """The size of the interface's frames: 16 classic, 72 CAN FD; None when it cannot be told."""
    import fcntl
    import struct

    try:
        with socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW) as probe:
            answer = fcntl.ioctl(probe, 0x8921, struct.pack("16si", interface.encode(), 0))  # SIOCGIFMTU
    except OSError:
        return None
    return int(struct.unpack("16si", answer)[1])


def explain(spec: CanSpec, fault: Fault) -> str:
    """One line on why the link cannot be opened, and the command that helps."""
    name = spec.interface
    if fault.number in (errno.EAFNOSUPPORT, errno.ESOCKTNOSUPPORT) or not _has_can():
        text = "this kernel has no CAN (modules can, can-raw)"
        text += f"; load them: {as_root('modprobe -a can-raw can-isotp')}, or run it under tools/with-can"
    elif fault.number == errno.EPROTONOSUPPORT:
        text = "this kernel has no ISO-TP (module can-isotp)"
        text += f"; load it: {as_root('modprobe can-isotp')}, or leave stack=kernel out"
    elif not _exists(name):
        text = f"there is no interface {name}; "
        if name.startswith("vcan"):
            text += f"make it: {as_root(f'ip link add {name} type vcan && ip link set {name} up')}"
        else:
            text += "plug the adapter in, then: ip -br link"
    elif fault.number in (errno.ENODEV, errno.ENXIO):
        text = f"{name} is no CAN interface; list those with: ip -br link show type can (or vcan)"
    elif fault.number in (errno.EPERM, errno.EACCES):
        text = "not permitted; a container needs the network of its host, or tools/with-can"
    else:
        text = f"{os.strerror(fault.number) if fault.number else fault.name}; see docs/can.md"
    return f"--can {name}: {text}"


def _has_can() -> bool:
    try:
        socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW).close()
    except OSError:
        return False
    return True


def _exists(interface: str) -> bool:
    return interface in (name for _, name in socket.if_nameindex())


class CanLink(Link):
    """A robot's end of an ISO-TP connection; errors of the bus are counted, never fatal."""

    def __init__(
        self, spec: CanSpec, clock_ms: Callable[[], float] = lambda: time.monotonic() * 1000
    ) -> None:
        self.spec = spec
        self.errors: Counter[str] = Counter()
        self.refused = 0
        self.lost_packets = 0
        self._clock_ms = clock_ms
        self._stack: Stack | None = None
        self._waiting: deque[tuple[bytes, float]] = deque()
        self._trouble = ""
        self._retry_ms = 0.0
        self._kind: Callable[[CanSpec], Stack] = UserStack if spec.stack == "user" else KernelStack

    def open(self) -> None:
        """Open the connection; an interface that is down is waited for."""
        if self.spec.fd and _mtu(self.spec.interface) == _CLASSIC_MTU:
            name = self.spec.interface
            raise LinkError(
                f"--can {name},fd: the interface carries classic CAN only; leave fd out, or: "
                f"{as_root(f'ip link set {name} down mtu 72')}, then up "
                "(an adapter: ip link set ... type can ... dbitrate N fd on)"
            )
        try:
            self._connect()
        except Fault as fault:
            raise LinkError(explain(self.spec, fault)) from fault

    def _connect(self) -> None:
        try:
            self._stack = self._kind(self.spec)
        except Fault as fault:
            if self.spec.stack != "auto" or self._kind is UserStack or fault.number not in _NO_CAN:
                raise
            self._stack = UserStack(self.spec)
            self._kind = UserStack
            load = as_root("modprobe can-isotp")
            _log.warning("this kernel has no ISO-TP (%s); using a stack in user space", load)

    @property
    def address(self) -> str:
        """What a client writes after `can:`."""
        return self.spec.for_client

    def _note(self, fault: Fault) -> None:
        """Count a fault, and tell once when the bus goes away."""
        self.errors[fault.name] += 1
        _log.debug("%s: %s", self.spec.interface, fault.name)
        if fault.number in _GONE:
            self._say_trouble("is gone; waiting for it to come back")
            self._drop_stack()
        elif fault.number == errno.ENETDOWN:
            self._say_trouble(f"is down; waiting for: ip link set {self.spec.interface} up")

    def _say_trouble(self, text: str) -> None:
        if self._trouble != text:
            self._trouble = text
            _log.warning("%s %s", self.spec.interface, text)

    def _say_well(self) -> None:
        if self._trouble:
            self._trouble = ""
            _log.warning("%s works again", self.spec.interface)

    def _drop_stack(self) -> None:
        if self._stack is not None:
            self._stack.close()
            self._stack = None
        self._retry_ms = self._clock_ms() + _REOPEN_MS

    def _reopen(self) -> None:
        if self._stack is None and self._clock_ms() >= self._retry_ms:
            try:
                self._connect()
            except Fault:
                self._retry_ms = self._clock_ms() + _REOPEN_MS

    def receive(self, now_ms: float) -> Iterable[bytes]:  # noqa: ARG002 (Link's shape)
        """Yield the packets that have arrived; a message that is not one packet is refused."""
        self._reopen()
        # Bounded, so that a bus full of errors cannot hold the robot's time.
        for _ in range(64):
            if self._stack is None:
                return
            try:
                pdu = self._stack.receive()
            except Fault as fault:
                self._note(fault)
                continue
            if pdu is None:
                return
            self._say_well()
            if is_packet(pdu):
                yield pdu
            else:
                self.refused += 1
                _log.debug("%s: refused a message of %d bytes", self.spec.interface, len(pdu))

    def send(self, packet: bytes, now_ms: float) -> None:
        """Queue a packet."""
        self._waiting.append((packet, now_ms))

    def transmit(self, now_ms: float) -> None:
        """Send what waits; what has waited too long is lost, as on a wire."""
        while self._waiting:
            packet, since_ms = self._waiting[0]
            sent = False
            try:
                sent = self._stack is not None and self._stack.send(packet)
            except Fault as fault:
                self._note(fault)
                self.lost_packets += 1
                self._waiting.popleft()
                continue
            if sent:
                self._waiting.popleft()
            elif self._stack is None or now_ms - since_ms > BACKLOG_MS:
                self.lost_packets += 1
                self._waiting.popleft()
            else:
                return

    def due_ms(self) -> float | None:
        """Soon, while something is on its way."""
        now_ms = self._clock_ms()
        due = None if self._stack is None else self._stack.due_ms(now_ms)
        return now_ms + _USER_STEP_MS if due is None and self._waiting else due

    def readers(self) -> list[Any]:
        """The socket."""
        return [] if self._stack is None else [self._stack.fileno()]

    def summary(self) -> str:
        """What was refused, lost and went wrong."""
        errors = ", ".join(f"{count} {name}" for name, count in sorted(self.errors.items())) or "no error"
        return f"CAN: {self.refused} messages refused, {self.lost_packets} packets lost, {errors}"

    def close(self) -> None:
        """Close the connection."""
        if self._stack is not None:
            self._stack.close()
            self._stack = None
