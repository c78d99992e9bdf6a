# SPDX-License-Identifier: Apache-2.0
"""clrt as a child process: lines that it says, its progress, and how it is stopped."""
import queue
import re
import subprocess
import threading

PROGRESS = re.compile(r"^(load|bvh|compile|render)\s+(\d+)%")
SAVES_WITHIN = 60  # seconds: a signal lets clrt finish and write its picture
SILENT_ENDS = {0, 5, 130, 143}  # 5: --error not reached; the others: by a signal; the picture is written


class Child:
    """A running clrt."""

    def __init__(self, command):
        self.lines = queue.Queue()
        self.said = []
        self.process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                                        encoding="utf-8", errors="replace")
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()

    def _read(self):
        for line in self.process.stderr:
            self.lines.put(line.rstrip())

    def news(self):
        """Lines since the last call."""
        fresh = []
        while not self.lines.empty():
            fresh.append(self.lines.get())
        self.said += fresh
        return fresh

    def is_over(self, seconds):
        """Waits so long for its end."""
        try:
            self.process.wait(seconds)
        except subprocess.TimeoutExpired:
            return False
        self.reader.join()
        self.process.stderr.close()
        return True

    def stop(self):
        """Lets it save what it has; kills it where that takes too long."""
        if self.process.poll() is None:
            self.process.terminate()
            if not self.is_over(SAVES_WITHIN):
                self.process.kill()
                self.is_over(None)

    def complaint(self):
        """Why there is no picture; None where there is one."""
        self.news()
        if self.process.returncode in SILENT_ENDS:
            return None
        errors = [line for line in self.said if "error" in line.lower()] or self.said[-3:]
        return f"clrt ended with {self.process.returncode}: " + "; ".join(errors)


def fraction_of(line):
    """The share of the render that a line of progress tells, or None."""
    found = PROGRESS.match(line)
    return int(found[2]) / 100 if found and found[1] == "render" else None
