"""The other ends of haptic devices, for tests of `pliant run --live`: each sends a sample, waits for its wrench, and sends the next.

A stroke is a list of (time, (x, y, z)); the devices do not turn. Times and positions are multiples of 2^-9 s and 2^-16 m, so that
formats with floats of 32 bits, millimetres or fractions of a second carry them exactly."""
import base64
import hashlib
import json
import math
import socket
import struct

RATE = 512
START = (0.25, 0.5, -0.125)
TIMEOUT = 60


def exact(x):
    return round(x * 65536) / 65536


def stroke(samples, way):
    """`way`(share): from the start [m]."""
    return [(k / RATE, tuple(exact(s + w) for s, w in zip(START, way(k / samples)))) for k in range(samples + 1)]


def press(share, depth=0.016):
    """Down onto the upper side and back, with a bit of a circle."""
    return (0.004 * math.sin(6 * share), 0.003 * (1 - math.cos(5 * share)), -depth * math.sin(math.pi * share))


def write_csv(file, samples, buttons=lambda t: 0):
    """buttons: at a time [s], a bit each."""
    rows = [f"{t!r},{x!r},{y!r},{z!r},0,0,0,1,{buttons(t)}\n" for t, (x, y, z) in samples]
    file.write_text("time,x,y,z,qx,qy,qz,qw,buttons\n" + "".join(rows))


class Udp:
    def __init__(self, port):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.settimeout(TIMEOUT)
        self.to = ("127.0.0.1", port)
        self.number = 0

    def send(self, time, position):
        self.number += 1
        self.socket.sendto(struct.pack("<4s3IQ8d", b"PLHP", 1, 88, 0, self.number, time, *position, 0, 0, 0, 1), self.to)

    def wrench(self):
        number, stamp, *forces = struct.unpack("<16xQ7d", self.socket.recv(80))
        assert number == self.number, (number, self.number)
        self.stamp = stamp
        return forces[:3]

    def close(self):
        self.socket.close()


class Osc(Udp):
    """Messages have no time: with --lockstep --rate they are 1/rate apart."""

    def send(self, time, position):
        self.socket.sendto(b"/pliant/pose\0\0\0\0,fffffff\0\0\0\0" + struct.pack(">7f", *position, 0, 0, 0, 1), self.to)

    def wrench(self):
        data = self.socket.recv(200)
        assert data[:24] == b"/pliant/wrench\0\0,ffffff\0", data
        return list(struct.unpack(">6f", data[24:]))[:3]


def crc64(data):
    crc = 0
    for byte in data:
        crc ^= byte << 56
        for _ in range(8):
            crc = (crc << 1 ^ (0x42F0E1EBA9EA3693 if crc >> 63 else 0)) & (1 << 64) - 1
    return crc


class Igtl:
    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port), TIMEOUT)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def send(self, time, position):
        body = struct.pack(">12f", 1, 0, 0, 0, 1, 0, 0, 0, 1, *(1000 * x for x in position))
        self.socket.sendall(struct.pack(">H12s20sQQQ", 1, b"TRANSFORM", b"Hand", int(time * 2**32), len(body), crc64(body)) + body)

    def read(self, size):
        data = b""
        while len(data) < size:
            part = self.socket.recv(size - len(data))
            assert part, "the connection was closed"
            data += part
        return data

    def wrench(self):
        version, kind, name, stamp, size, crc = struct.unpack(">H12s20sQQQ", self.read(58))
        body = self.read(size)
        assert (kind.rstrip(b"\0"), name.rstrip(b"\0"), crc) == (b"SENSOR", b"PliantWrench", crc64(body))
        self.stamp = stamp / 2**32
        return list(struct.unpack(">6d", body[10:]))[:3]

    def close(self):
        self.socket.close()


class Haply:
    """The Inverse service of Haply: here Pliant is the client."""

    def __init__(self):
        self.listening = socket.create_server(("127.0.0.1", 0))
        self.listening.settimeout(TIMEOUT)
        self.port = self.listening.getsockname()[1]
        self.socket = None

    def welcome(self):
        self.socket, _ = self.listening.accept()
        self.socket.settimeout(TIMEOUT)
        head = b""
        while b"\r\n\r\n" not in head:
            head += self.socket.recv(4096)
        key = [line.split(b":")[1].strip() for line in head.split(b"\r\n") if line.lower().startswith(b"sec-websocket-key:")][0]
        accept = base64.b64encode(hashlib.sha1(key + b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11").digest())
        protocol = b"Sec-WebSocket-Protocol: pliant\r\n" if b"sec-websocket-protocol" in head.lower() else b""
        self.socket.sendall(b"HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n" + protocol
                            + b"Sec-WebSocket-Accept: " + accept + b"\r\n\r\n")

    def send(self, time, position):
        if self.socket is None:
            self.welcome()
        text = json.dumps({"inverse3": [{"device_id": "04AF", "state": {"cursor_position": dict(zip("xyz", position))}}]}).encode()
        self.socket.sendall(bytes([0x81]) + (bytes([len(text)]) if len(text) < 126 else bytes([126]) + struct.pack(">H", len(text))) + text)

    read = Igtl.read

    def wrench(self):
        while True:
            first, second = self.read(2)
            size = second & 127
            if size == 126:
                size = struct.unpack(">H", self.read(2))[0]
            mask, data = self.read(4), self.read(size)
            text = bytes(b ^ mask[i % 4] for i, b in enumerate(data))
            if first & 15 == 1:
                force = json.loads(text)["inverse3"][0]["commands"]["set_cursor_force"]["vector"]
                return [force["x"], force["y"], force["z"]]
            assert first & 15 == 9, f"a frame of kind {first & 15}"  # ping

    def close(self):
        for s in (self.socket, self.listening):
            if s is not None:
                s.close()


def exchange(end, samples):
    """Returns the forces."""
    forces = []
    for time, position in samples:
        end.send(time, position)
        forces.append(end.wrench())
    return forces
