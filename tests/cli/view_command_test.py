# SPDX-License-Identifier: Apache-2.0
"""The picture in view while it grows: --serve and --display-server of a running clrt, on this machine alone:
view_command_test.py PATH/clrt."""
import array
import http.client
import json
import os
import re
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from urllib.parse import urlsplit

CLRT = os.path.abspath(sys.argv.pop(1)) if len(sys.argv) > 1 else "clrt"
DEVICE = os.environ.get("CLRT_TEST_DEVICE", "pocl")
SQUARE = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n"
LIMIT = 60  # seconds that anything may take
ENDLESS = ("-s", "2000000", "-t", "100")


class Tev:
    """A socket that takes what tev takes, and what it has come to."""

    def __init__(self, packets_at_most=None):
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        self.packets_at_most = packets_at_most
        self.created, self.image, self.updates = None, None, 0
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        connection = self.listener.accept()[0]
        with connection, connection.makefile("rb") as stream:
            count = 0
            while count != self.packets_at_most and (head := stream.read(4)):
                self.take(stream.read(struct.unpack("<I", head)[0] - 4))
                count += 1
        self.listener.close()

    def take(self, packet):
        def text():
            nonlocal at
            end = packet.index(b"\0", at)
            word, at = packet[at:end].decode(), end + 1
            return word

        def whole(form):
            nonlocal at
            value = struct.unpack_from("<" + form, packet, at)
            at += struct.calcsize("<" + form)
            return value

        kind, at = packet[0], 2
        name = text()
        if kind == 4:
            width, height, count = whole("iii")
            self.created = (name, width, height, [text() for _ in range(count)])
            self.image = [None] * height
        else:
            assert kind == 6 and name == self.created[0], (kind, name)
            channels = [text() for _ in range(whole("i")[0])]
            x, y, width, height = whole("iiii")
            count = len(channels)
            assert (x, width, channels) == (0, self.created[1], self.created[3])
            assert whole("q" * 2 * count) == tuple(range(count)) + (count,) * count
            values = array.array("f", packet[at:])
            assert len(values) == width * height * count
            for row in range(height):
                self.image[y + row] = values[row * width * count:(row + 1) * width * count]
            self.updates += 1


class Page:
    """A client of the page at an address."""

    def __init__(self, url):
        parts = urlsplit(url)
        self.host, self.port, self.path = parts.hostname, parts.port, parts.path

    def ask(self, name, method="GET", path=None, headers=None):
        connection = http.client.HTTPConnection(self.host, self.port, timeout=LIMIT)
        try:
            connection.putrequest(method, (self.path if path is None else path) + name, skip_host=headers is not None)
            for key, value in headers or ():
                connection.putheader(key, value)
            connection.endheaders()
            response = connection.getresponse()
            return response.status, response.headers, response.read()
        finally:
            connection.close()

    def state(self):
        return json.loads(self.ask("state?page=test")[2])

    def state_when(self, condition):
        end = time.monotonic() + LIMIT
        while not condition(state := self.state()):
            assert time.monotonic() < end, state
            time.sleep(0.05)
        return state


class ViewCommand(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        with open(os.path.join(self.folder, "square.obj"), "w", encoding="utf-8") as file:
            file.write(SQUARE)

    def start(self, *arguments):
        """A running clrt."""
        process = subprocess.Popen([CLRT, "square.obj", "-d", DEVICE, "-r", "32x24", "--env", "1,2,3", *arguments], cwd=self.folder,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        return process

    def serve(self, *arguments, port="0"):
        """A running clrt and its page."""
        process = self.start("--serve", port, *arguments)
        lines = []
        while not (found := re.search(r"the picture is in view at (http://127\.0\.0\.1:\d+/[0-9a-f]{32}/)$", lines[-1] if lines else "", re.M)):
            lines.append(process.stderr.readline())
            self.assertTrue(lines[-1], "".join(lines))
        return process, Page(found[1])

    def end(self, process, code):
        """What it has printed to both streams, once it has ended."""
        out, err = process.communicate(timeout=LIMIT)
        self.assertEqual(process.returncode, code, out + err)
        return out + err

    def bytes_of(self, name):
        with open(os.path.join(self.folder, name), "rb") as file:
            return file.read()

    def test_the_page_shows_the_render_and_stops_it(self):
        process, page = self.serve(*ENDLESS, "-q", "-o", "a.pfm", "--checkpoint", "a.film")
        picture = page.state_when(lambda state: state["picture"])["picture"]
        self.assertEqual((picture["width"], picture["height"]), (32, 24))
        status, headers, text = page.ask("")
        self.assertEqual(status, 200)
        self.assertIn("default-src 'none'", headers["Content-Security-Policy"])
        self.assertEqual((headers["X-Content-Type-Options"], headers["Referrer-Policy"], headers["Cache-Control"]),
                         ("nosniff", "no-referrer", "no-store"))
        self.assertIn(b"<!DOCTYPE html>", text)
        for name in ("picture.bmp?exposure=1&tonemap=agx", "error.bmp"):
            status, headers, bmp = page.ask(name)
            self.assertEqual((status, headers["Content-Type"], bmp[:2], len(bmp)), (200, "image/bmp", b"BM", 54 + 3 * 32 * 24))

        later = page.state_when(lambda state: state["picture"]["version"] > picture["version"])
        self.assertGreater(later["picture"]["spp"], picture["spp"], "it goes on growing")
        self.assertLess(later["picture"]["error"]["low"], later["picture"]["error"]["high"])
        self.assertEqual(later["progress"]["phase"], "render")

        record = json.loads(page.ask("path?x=16&y=12&sample=3")[2])
        self.assertIsNone(record["error"])
        self.assertEqual((record["record"]["pixel"], record["record"]["sample"]), ([16, 12], 3))
        self.assertIn("sample 3 of pixel 16,12", record["text"])

        self.assertEqual(page.ask("save", "POST")[0], 202)
        self.assertRegex(page.state_when(lambda state: state["message"])["message"], r"^saved at \d+ samples a pixel$")
        self.assertTrue(self.bytes_of("a.pfm") and self.bytes_of("a.film"))

        # It waits for this page, which has looked, to have the last picture.
        self.assertEqual(page.ask("stop", "POST")[0], 202)
        last = page.state_when(lambda state: state["end"])
        self.assertRegex(last["end"], r"^stopped after \d+ samples a pixel; ")
        self.assertIn(f"after {last['picture']['spp']} samples", last["end"])
        page.ask("goodbye?page=test", "POST")
        self.end(process, 128 + signal.SIGINT)

    def test_nobody_else_is_let_through(self):
        process, page = self.serve(*ENDLESS)
        here = f"127.0.0.1:{page.port}"
        for path in ("/", "/state", page.path[:-2] + "/", "/" + "0" * 32 + "/"):
            self.assertEqual(page.ask("", path=path)[0], 404, path)
        for headers in ([], [("Host", "example.org")], [("Host", "127.0.0.1")], [("Host", here), ("Host", here)]):
            self.assertIn(page.ask("state", headers=headers)[0], (400, 403), headers)
        for origin, status in (("http://example.org", 403), ("null", 403), (f"http://localhost:{page.port}", 403), (f"http://{here}", 405)):
            self.assertEqual(page.ask("stop", "GET", headers=[("Host", here), ("Origin", origin)])[0], status, origin)
        self.assertEqual(page.ask("stop", "POST", headers=[("Host", here), ("Origin", "http://example.org")])[0], 403)
        self.assertFalse(page.state()["is_stopping"])
        for address in ("0.0.0.0", socket.gethostbyname(socket.gethostname())):
            if not address.startswith(("127.", "0.")):
                with self.assertRaises(OSError):
                    socket.create_connection((address, page.port), timeout=2)
        page.ask("stop", "POST")
        page.ask("goodbye?page=test", "POST")
        self.end(process, 130)

    def test_a_port_that_is_taken_is_said(self):
        with socket.create_server(("127.0.0.1", 0)) as taken:
            port = taken.getsockname()[1]
            text = self.end(self.start("--serve", str(port), "-s", "1"), 2)
            self.assertIn(f"option --serve: expected a port of this machine that is free and that a user may take, found {port}", text)
        text = self.end(self.start("--display-server", f"127.0.0.1:{port}", "-s", "1"), 2)
        self.assertIn(f"option --display-server: expected tev to listen on port {port} of '127.0.0.1', found: Connection refused", text)
        self.assertEqual(os.listdir(self.folder), ["square.obj"])

    def test_the_page_stays_where_it_is_asked_to(self):
        process, page = self.serve("-s", "8", port="0,stay")
        state = page.state_when(lambda answer: answer["end"])
        self.assertEqual((state["picture"]["spp"], state["end"]), (8, "done: --spp 8 is complete"))
        self.assertIsNone(json.loads(page.ask("path?x=16&y=12&sample=0")[2])["error"])
        self.assertTrue(self.bytes_of("square.png"))
        self.assertIsNone(process.poll())
        page.ask("stop", "POST")
        self.end(process, 0)

    def test_who_looks_changes_no_bit(self):
        arguments = ("-s", "40", "-r", "61x47", "-o", "a.exr", "-o", "a.pfm", "--stats", "a.json")
        self.end(self.start(*arguments), 0)
        alone = self.bytes_of("a.pfm")
        tev = Tev()
        process, page = self.serve("--display-server", f"127.0.0.1:{tev.port}", *arguments)
        state = page.state_when(lambda answer: answer["end"])
        page.ask("goodbye?page=test", "POST")
        self.end(process, 0)
        self.assertEqual(self.bytes_of("a.pfm"), alone)
        self.assertEqual(state["picture"]["spp"], 40)

        # The last picture of tev is that of the file, whose rows go from the bottom.
        tev.thread.join(LIMIT)
        self.assertEqual(tev.created, ("square.obj", 61, 47, ["R", "G", "B", "error.Y"]))
        rows = array.array("f", alone[-4 * 3 * 61 * 47:])
        for y in range(47):
            row, shown = rows[3 * 61 * (46 - y):3 * 61 * (47 - y)], tev.image[y]
            self.assertEqual([shown[4 * x + c] for x in range(61) for c in range(3)], list(row), y)
        errors = [tev.image[y][4 * x + 3] for y in range(47) for x in range(61)]
        with open(os.path.join(self.folder, "a.json"), encoding="utf-8") as file:
            stated = json.load(file)["error"]["rel_rmse"]
        pixels = sum(error > 0 for error in errors)  # the others show the sky, which has none
        self.assertAlmostEqual((sum(error ** 2 for error in errors) / pixels) ** 0.5, stated, delta=1e-4 * stated)

    def test_a_viewer_that_vanishes_costs_one_notice(self):
        tev = Tev(packets_at_most=2)
        text = self.end(self.start("--display-server", f"127.0.0.1:{tev.port}", "-t", "2", "-s", "2000000"), 0)
        self.assertEqual(text.count("the viewer of --display-server is left: it has closed the connection"), 1, text)
        self.assertTrue(self.bytes_of("square.png"))


if __name__ == "__main__":
    unittest.main()
