#!/usr/bin/env python3
"""Runs a program at a pseudo-terminal, like a person at the keyboard.

  at_terminal.py STEP... -- COMMAND...

The STEPs are executed in order: `wait TEXT` waits until the program has printed TEXT, `keys TEXT` types it (\\n is Enter,
\\x03 Ctrl-C), `raw` waits until the terminal neither waits for Enter nor echoes keys, `hangup` closes the terminal.
Prints the output of the program, then whether the terminal has its old settings, and ends with the program's exit code
(128 + N: signal N).
"""
import fcntl
import os
import pty
import select
import sys
import termios
import time

PATIENCE = 120  # s, for a busy machine; no pass criterion


class Terminal:
    """A program and its terminal."""

    def __init__(self, command):
        self.keyboard, self.line = pty.openpty()
        self.before = termios.tcgetattr(self.line)
        self.said = b""
        self.seen = 0
        self.end = time.monotonic() + PATIENCE
        self.status = None
        self.child = os.fork()
        if self.child == 0:
            os.setsid()
            fcntl.ioctl(self.line, termios.TIOCSCTTY, 0)
            for fd in (0, 1, 2):
                os.dup2(self.line, fd)
            os.closerange(3, 64)
            os.environ["TERM"] = "xterm"  # progress is not shown at a dumb terminal
            os.execvp(command[0], command)

    def fail(self, why):
        os.write(1, self.said)
        os.kill(self.child, 9)
        sys.exit(f"at_terminal.py: {why}")

    def listen(self):
        """Reads the output of the program; returns whether it still runs."""
        if time.monotonic() > self.end:
            self.fail("the program did not end in time")
        while self.keyboard >= 0 and select.select([self.keyboard], [], [], 0.02)[0]:
            self.said += os.read(self.keyboard, 4096)
        if self.status is None:
            done, status = os.waitpid(self.child, os.WNOHANG)
            self.status = status if done else None
            return True  # read the last output
        return False

    def until(self, true, what):
        while not true():
            if not self.listen():
                self.fail(f"never {what}")

    def wait(self, text):
        self.until(lambda: self.said.find(text, self.seen) >= 0, f"printed {text!r}")
        self.seen = self.said.find(text, self.seen) + len(text)

    def modes(self):
        return termios.tcgetattr(self.line)[3] & (termios.ICANON | termios.ECHO)

    def hang_up(self):
        os.close(self.keyboard)
        os.close(self.line)
        self.keyboard = self.line = -1


def main():
    split = sys.argv.index("--")
    steps, command = sys.argv[1:split], sys.argv[split + 1:]
    terminal = Terminal(command)
    while steps:
        step = steps.pop(0)
        if step in ("wait", "keys"):
            text = steps.pop(0).encode().decode("unicode_escape").encode()
        if step == "wait":
            terminal.wait(text)
        elif step == "keys":
            os.write(terminal.keyboard, text)
        elif step == "raw":
            terminal.until(lambda: terminal.modes() == 0, "read keys without Enter")
        elif step == "hangup":
            terminal.hang_up()
        else:
            terminal.fail(f"unknown step {step}")
    while terminal.listen():
        if terminal.keyboard < 0:
            time.sleep(0.02)
    os.write(1, terminal.said)
    if terminal.line >= 0:
        same = termios.tcgetattr(terminal.line) == terminal.before
        print("The terminal was left as it was." if same else "THE TERMINAL WAS LEFT OTHERWISE.")
    code = os.waitstatus_to_exitcode(terminal.status)
    sys.exit(code if code >= 0 else 128 - code)


main()
