"""A board that reads a rolling model, on a pseudo-terminal with the rights of a serial port.

Usage: board.py LINK GROUP   (LINK is where the port is to be found; decay after decay at 100 Hz)
"""
import fcntl
import math
import os
import pty
import sys
import termios
import time
import tty

link, group = sys.argv[1:]
master, slave = pty.openpty()
tty.setraw(slave)
name = os.ttyname(slave)
os.chown(name, 0, int(group))
os.chmod(name, 0o660)
if os.path.lexists(link):
    os.remove(link)
os.symlink(name, link)
os.set_blocking(master, False)
start, seq = time.monotonic(), 0
NOT_EXCLUSIVE = getattr(termios, "TIOCNXCL", 0x540D)
while True:
    at = start + seq / 100.0
    time.sleep(max(0.0, at - time.monotonic()))
    t = (at - start) % 20.0
    noise = 6e-4 * math.sin(111.0 * at) + 6e-4 * math.sin(197.0 * at)
    free = t - 5.0
    roll = 0.19 * math.exp(-0.225 * free) * math.cos(6.9 * free) if 0.0 < free < 13.0 else 0.0
    body = f"RD,{seq},{seq * 10000 % 2**32},{round(1e5 * (roll + noise))}"
    check = 0
    for byte in body.encode():
        check ^= byte
    try:
        os.write(master, f"${body}*{check:02X}\r\n".encode())
        os.read(master, 4096)
    except BlockingIOError:
        pass
    # A real port forgets who had it to himself when he dies; one whose other end is open does not.
    fcntl.ioctl(slave, NOT_EXCLUSIVE)
    seq += 1
