"""Halts a process before each of its calls of the system that change files, those of libraries included.

The kernel asks another process whether such a call may go on (seccomp_unotify(2)). Meanwhile a test looks at the files:
a kill at that moment would leave them as they are.
"""

from __future__ import annotations

import ctypes
import fcntl
import os
import platform
import select
import signal
import socket
import stat
import struct
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

NUMBERS = {  # of the calls
    "x86_64": {
        "write": 1, "pwrite64": 18, "writev": 20, "sendfile": 40, "copy_file_range": 326, "truncate": 76,
        "ftruncate": 77, "open": 2, "openat": 257, "rename": 82, "renameat": 264, "renameat2": 316, "unlink": 87,
        "unlinkat": 263, "mkdir": 83, "mkdirat": 258, "rmdir": 84, "link": 86, "linkat": 265, "symlink": 88,
        "symlinkat": 266, "chmod": 90, "fchmod": 91, "fchmodat": 268, "chown": 92, "fchown": 93, "fchownat": 260,
        "seccomp": 317,
    },
    "aarch64": {
        "write": 64, "pwrite64": 68, "writev": 66, "sendfile": 71, "copy_file_range": 285, "truncate": 45,
        "ftruncate": 46, "openat": 56, "renameat": 38, "renameat2": 276, "unlinkat": 35, "mkdirat": 34,
        "linkat": 37, "symlinkat": 36, "fchmod": 52, "fchmodat": 53, "fchown": 55, "fchownat": 54, "seccomp": 277,
    },
}.get(platform.machine(), {})  # fmt: skip
SECCOMP = NUMBERS.pop("seccomp", None)
NAMES = {number: name for name, number in NUMBERS.items()}
FLAGS = {"open": 1, "openat": 2}  # argument with the flags, of calls that change files by some of them
ARGUMENTS = 16  # offset in struct seccomp_data
ASK, ALLOW = 0x7FC00000, 0x7FFF0000  # SECCOMP_RET_USER_NOTIF and SECCOMP_RET_ALLOW
RECEIVE, SEND = 0xC0502100, 0xC0182101  # requests of ioctl
LIBRARY = ctypes.CDLL(None, use_errno=True)


def halts(do: Callable[[], object]) -> Iterator[str]:
    """Does it in another process; yields the name of each call before it is carried out.

    Whoever asks for no further call kills the process.
    """
    if SECCOMP is None:
        pytest.skip("this kernel halts no calls")
    ours, theirs = socket.socketpair()
    child = os.fork()
    if not child:
        try:
            _halt_calls(theirs)
            do()
            os._exit(0)
        finally:
            os._exit(1)
    theirs.close()
    with ours:
        listener = socket.recv_fds(ours, 1, 1)[1][0]
    killed = True
    try:
        for thread, call, name, first in _halted(listener):
            if "write" not in name or stat.S_ISREG(Path(f"/proc/{thread}/fd/{first}").stat().st_mode):  # no pipe
                yield name
            fcntl.ioctl(listener, SEND, struct.pack("QqiI", call, 0, 0, 1))
        killed = False
    finally:
        if killed:
            os.kill(child, signal.SIGKILL)
        os.close(listener)
        status = os.waitpid(child, 0)[1]
    assert status == 0, status


def _halt_calls(to: socket.socket) -> None:
    """Lets the kernel ask before calls of this process; sends the file on which it asks."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    os.dup2(1, 2)
    code = ctypes.create_string_buffer(program := _filter())
    LIBRARY.prctl(38, 1, 0, 0, 0)  # PR_SET_NO_NEW_PRIVS, without which only root may
    filters = struct.pack("HxxxxxxP", len(program) // 8, ctypes.addressof(code))
    listener = LIBRARY.syscall(SECCOMP, 1, 8, ctypes.create_string_buffer(filters))  # with a new listener
    if listener < 0:
        raise OSError(ctypes.get_errno(), "seccomp")
    socket.send_fds(to, [b"."], [listener])


def _filter() -> bytes:
    """The program with which the kernel chooses the calls."""
    code = _instruction(0x20, 0)  # loads the number
    for name, number in NUMBERS.items():
        if name in FLAGS:
            code += _instruction(0x15, number, 0, 4)  # four on, for another number
            code += _instruction(0x20, ARGUMENTS + 8 * FLAGS[name])  # loads the flags
            code += _instruction(0x45, os.O_CREAT | os.O_TRUNC, 0, 1)  # one on, without both
            code += _instruction(6, ASK) + _instruction(6, ALLOW)
        else:
            code += _instruction(0x15, number, 0, 1) + _instruction(6, ASK)
    return code + _instruction(6, ALLOW)


def _instruction(code: int, value: int, if_true: int = 0, if_false: int = 0) -> bytes:
    return struct.pack("HBBI", code, if_true, if_false, value)


def _halted(listener: int) -> Iterator[tuple[int, int, str, int]]:
    """The calls until the process ends: thread, identity, name and first argument of each."""
    poll = select.poll()
    poll.register(listener, select.POLLIN)
    while poll.poll()[0][1] & select.POLLIN:
        about = bytearray(80)  # struct seccomp_notif
        fcntl.ioctl(listener, RECEIVE, about)
        call, thread, _, number, _, _, first = struct.unpack_from("QIIiIQQ", about)
        yield thread, call, NAMES[number], first
