"""rimod's processes in a private network, and just enough of LCM (a log's events, UDP multicast) to play a log to them
and see when their answers come. Linux only; needs unshare and ip, as the tests do."""
import os
import pathlib
import re
import select
import socket
import struct
import subprocess
import sys
import tempfile
import time

GROUP, PORT = '239.255.76.67', 7667  # LCM's default
SHORT_MESSAGE, FRAGMENT = 0x4c433032, 0x4c433033
LOG_SYNC = 0xEDA1DA01
IN_PRIVATE_NETWORK = 'RIMOD_BENCHMARK_IN_PRIVATE_NETWORK'
MICROSECONDS = 1e6


def enter_private_network():
    """Starts this program anew where nothing that is sent leaves the machine."""
    if os.environ.get(IN_PRIVATE_NETWORK) == 'yes':
        return
    os.environ[IN_PRIVATE_NETWORK] = 'yes'
    os.environ.pop('LCM_DEFAULT_URL', None)
    set_up = 'ip link set lo up && ip link set lo multicast on && ip route add 224.0.0.0/4 dev lo && exec "$0" "$@"'
    os.execvp('unshare', ['unshare', '-rn', 'sh', '-c', set_up, sys.executable, *sys.argv])


def read_log(path):
    """The events of an LCM log: (time in us, channel, bytes)."""
    data, at, events = pathlib.Path(path).read_bytes(), 0, []
    while at + 28 <= len(data):
        sync, _, utime, channel_size, size = struct.unpack_from('>IqqII', data, at)
        if sync != LOG_SYNC:
            raise SystemExit(f'{path}: is not an LCM log, or damaged at byte {at}')
        at += 28
        events.append((utime, data[at:at + channel_size].decode(), data[at + channel_size:at + channel_size + size]))
        at += channel_size + size
    return events


def utime_of(message):
    """The field that every message begins with, behind the type's fingerprint."""
    return struct.unpack_from('>q', message, 8)[0]


class Bus:
    """LCM's default group: sends and receives messages of one datagram."""

    def __init__(self):
        self.out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.out.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
        self.sequence = 0
        self.inp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.inp.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.inp.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        self.inp.bind((GROUP, PORT))
        self.inp.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                            struct.pack('4s4s', socket.inet_aton(GROUP), socket.inet_aton('0.0.0.0')))

    def publish(self, channel, message):
        self.out.sendto(struct.pack('>II', SHORT_MESSAGE, self.sequence) + channel.encode() + b'\0' + message, (GROUP, PORT))
        self.sequence += 1

    def receive(self, until):
        """What comes before the time (time.monotonic): (time of arrival, channel, bytes); sections of large messages are told
        by their first fragment. None when it is over."""
        while True:
            left = until - time.monotonic()
            if not select.select([self.inp], [], [], max(left, 0))[0]:
                return None
            datagram, now = self.inp.recv(65536), time.monotonic()
            magic, _ = struct.unpack_from('>II', datagram)
            if magic == SHORT_MESSAGE:
                channel, _, message = datagram[8:].partition(b'\0')
                return now, channel.decode(), message


class Processes:
    """Processes of the system until the end of a `with`; their messages go to files."""

    def __init__(self, build):
        self.bin = pathlib.Path(build) / 'bin'
        self.running, self.folder = {}, tempfile.TemporaryDirectory()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in self.running.values():
            process.terminate()
        for process in self.running.values():
            process.wait(10)
        self.folder.cleanup()

    def start(self, name, *arguments):
        with open(self.log(name), 'w') as log:
            self.running[name] = subprocess.Popen([self.bin / name, *map(str, arguments)], stdout=log, stderr=log)

    def log(self, name):
        return pathlib.Path(self.folder.name) / name

    def wait_for(self, name, pattern, timeout=60.0):
        """When a process has written a line: seconds from now until then."""
        begin = time.monotonic()
        while time.monotonic() < begin + timeout:
            if re.search(pattern, self.log(name).read_text()):
                return time.monotonic() - begin
            if self.running[name].poll() is not None:
                break
            time.sleep(0.002)
        raise SystemExit(f'{name} wrote no "{pattern}":\n{self.log(name).read_text()[-2000:]}')

    def memory(self, name):
        """Resident now and at most, MB."""
        status = pathlib.Path(f'/proc/{self.running[name].pid}/status').read_text()
        return [int(re.search(key + r':\s*(\d+)', status)[1]) / 1000 for key in ('VmRSS', 'VmHWM')]
