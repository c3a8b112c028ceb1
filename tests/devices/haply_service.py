#!/usr/bin/env python3
"""Plays Haply's Inverse service for tests/devices. Usage: haply_service.py PORT_FILE LOG_FILE lockstep | stream | garbage

Listens on a port of its own choice, which it writes to PORT_FILE. Appends each message that it receives to LOG_FILE, a line each.
lockstep: sends state i, at x = i mm, when it has the answer to state i - 1. stream: a state each 2 ms. garbage: as lockstep with
pauses, each state among messages that are none. Exit code 77: there is no module websockets.
"""
import asyncio
import json
import os
import sys

try:
    import websockets
except ImportError:
    sys.exit(77)

port_file, log_file, mode = sys.argv[1:]
log = open(log_file, "w", buffering=1)


def state(i):
    def device(name, x, y, z):
        vector = {"x": x, "y": y, "z": z}
        return {"device_id": name, "config": {"handedness": "right"}, "state": {"cursor_position": vector, "cursor_velocity": vector}}
    grip = {"device_id": "61576", "state": {"orientation": {"x": 0.0, "y": 0.6, "z": 0.0, "w": 0.8}, "buttons": {"a": True, "b": False}}}
    return json.dumps({"inverse3": [device("04AF", 1e-3 * i, -0.15, 0.2), device("04B0", 1, 2, 3)], "wireless_verse_grip": [grip]})


async def listen(socket):
    async for message in socket:
        log.write(message + "\n")


async def serve(socket, path=None):
    try:
        if mode == "stream":
            reader = asyncio.create_task(listen(socket))
            for i in range(100000):
                await socket.send(state(i))
                await asyncio.sleep(0.002)
            reader.cancel()
        for i in range(100000):
            if mode == "garbage":
                await socket.send("{")
                await socket.send(b"\x00\xff" * 100)
                await socket.send("[" * 200000)
                await socket.send(json.dumps({"events": []}))
                text = state(i)
                await socket.send([text[:10], text[10:50], text[50:]])  # in three fragments
                await asyncio.sleep(0.02)
            else:
                await socket.send(state(i))
            log.write(await socket.recv() + "\n")
    except websockets.ConnectionClosed:
        pass


async def main():
    async with websockets.serve(serve, "127.0.0.1", 0) as server:
        port = server.sockets[0].getsockname()[1]
        with open(port_file + ".new", "w") as file:
            file.write(f"{port}\n")
        os.rename(port_file + ".new", port_file)
        await asyncio.Future()


asyncio.run(main())
