"""The page of talkgraph annotate in a real browser: browser_test.py path/to/talkgraph [folder for pictures of it]"""

import json
import math
import pathlib
import struct
import sys
import tempfile
import unittest
import wave
import zlib

from browser import Browser, Server, programs, wait_for

SIZE, FRAMES = 160, 6
NAMES = ["left temple", "right temple", "left eye", "right eye", "left mouth", "right mouth", "lower lip", "chin"]
SCHEME = {"name": "simple", "groups": [
    {"name": "outline", "points": [0, 7, 1]}, {"name": "eyes", "points": [2, 3]},
    {"name": "mouth", "points": [4, 6, 5], "closed": True}],
    "pairs": [[0, 1], [2, 3], [4, 5]],
    "mean": [[-40, -30], [40, -30], [-18, -15], [18, -15], [-15, 22], [15, 22], [0, 30], [0, 50]]}


def truth(frame):
    """Points of the face drawn on a frame."""
    x, y, mouth = 78 + 2 * math.sin(frame), 76 + 2 * math.cos(frame), 4 + 6 * abs(math.sin(1.7 * frame))
    return [[x - 40, y - 30], [x + 40, y - 30], [x - 18, y - 15], [x + 18, y - 15], [x - 15, y + 22], [x + 15, y + 22],
            [x, y + 24 + mouth], [x, y + 46 + mouth / 2]]


def picture(frame):
    """A PNG of a simple face."""
    p = truth(frame)
    x0, y0, mouth = p[6][0], p[0][1] + 30, p[6][1] - p[4][1]
    rows = bytearray()
    for y in range(SIZE):
        rows.append(0)
        for x in range(SIZE):
            r, g, b = 60 + x // 4, 80 + y // 4, 110
            if ((x - x0) / 44) ** 2 + ((y - y0) / 52) ** 2 < 1:
                r, g, b = 205 + (x - SIZE // 2) // 2, 150 + (y - SIZE // 2) // 3, 120
            for eye in (p[2], p[3]):
                if math.hypot(x - eye[0], 1.5 * (y - eye[1])) < 7:
                    r, g, b = 40, 50, 60
            if ((x - x0) / 16) ** 2 + ((y - p[4][1]) / mouth) ** 2 < 1:
                r, g, b = 150, 40, 50
            rows += bytes((r, g, b))
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    head = struct.pack(">IIBBBBB", SIZE, SIZE, 8, 2, 0, 0, 0)
    data = zlib.compress(bytes(rows))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", data) + chunk(b"IEND", b"")


def make_corpus(folder):
    (folder / "clip").mkdir()
    for frame in range(FRAMES):
        (folder / "clip" / f"{frame}.png").write_bytes(picture(frame))
    with wave.open(str(folder / "a.wav"), "wb") as sound:
        sound.setparams((1, 2, 8000, 0, "NONE", ""))
        sound.writeframes(bytes(2 * 8000 * FRAMES // 25))
    (folder / "simple.json").write_text(json.dumps(SCHEME))
    clip = {"id": "clip", "video": "clip", "audio": "a.wav"}
    (folder / "manifest.json").write_text(json.dumps({"rate": 25, "clips": [clip]}))


def read_points(file):
    """0-based points of a .pts file."""
    text = file.read_text().split("{")[1].split("}")[0].split()
    return [[float(x) - 1, float(y) - 1] for x, y in zip(text[::2], text[1::2])]


class AnnotateTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="talkgraph-browser-")
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        make_corpus(self.folder)
        self.server = Server(PROGRAM, str(self.folder / "manifest.json"), "--frames", "5", "--scheme",
                             str(self.folder / "simple.json"))
        self.addCleanup(lambda: self.server.process.poll() is None and self.server.kill())
        profile = tempfile.TemporaryDirectory(prefix="talkgraph-profile-", ignore_cleanup_errors=True)
        self.addCleanup(profile.cleanup)
        self.browser = Browser(profile.name)
        self.addCleanup(self.browser.quit)
        self.open()

    def open(self):
        self.browser.open(self.server.url)
        self.ready()

    def ready(self):
        opened = "return typeof current !== 'undefined' && !!current?.points && opened === current"
        wait_for(lambda: self.browser.run(opened), "the page")
        wait_for(lambda: not self.status().startswith("opening"), "a frame")

    # What the page shows.
    def status(self):
        return self.browser.run("return document.getElementById('status').textContent")

    def shown(self):
        """Points as drawn, pixels of the picture."""
        return self.browser.run("return [...document.querySelectorAll('#points circle')]"
                                ".map(c => [Number(c.getAttribute('cx')), Number(c.getAttribute('cy'))])")

    def place(self, point):
        """Of a point in the window."""
        return self.browser.run("const circle = document.querySelectorAll('#points circle')[arguments[0]];"
                                "const b = circle.getBoundingClientRect();"
                                "return [b.x + b.width / 2, b.y + b.height / 2]", point)

    def scale(self):
        return self.browser.run("return view.scale")

    # What is kept.
    def kept(self):
        """(file name, points) of the frame that is open; None if there is none."""
        index, frames = self.browser.run("return current.index"), self.server.get("api/project")["frames"]
        stem = self.folder / "annotated" / frames[index]["clip"] / f"{frames[index]['number']:06}"
        for ending in (".draft", ".pts"):
            file = stem.with_suffix(ending)
            if file.exists():
                return file.name, read_points(file)
        return None

    def close(self, a, b, within=0.02):
        return a and b and all(math.dist(p, q) <= within for p, q in zip(a, b))

    def saved(self, ending=".draft"):
        """Waits until the file of the frame holds what is shown."""
        def same():
            kept = self.kept()
            return kept and kept[0].endswith(ending) and self.close(kept[1], self.shown())
        wait_for(same, "points to be kept as they are shown")
        return self.shown()

    def drag(self, point, dx, dy, modifier=None):
        x, y = self.place(point)
        self.browser.drag((x, y), (x + dx, y + dy), modifier)

    def picture(self, name):
        if PICTURES:
            self.browser.screenshot(PICTURES / f"{name}.png")

    def test_drag_undo_redo_and_reload(self):
        self.assertIn("mean shape of the scheme", self.status())
        begun, scale = self.shown(), self.scale()
        self.assertGreater(scale, 3, "the picture fills the page")
        self.drag(6, 40, 20)
        moved = self.saved()
        for i, (before, after) in enumerate(zip(begun, moved)):
            expected = [before[0] + 40 / scale, before[1] + 20 / scale] if i == 6 else before
            self.assertLess(math.dist(expected, after), 1.5 / scale, NAMES[i])
        self.drag(7, 0, 30)
        twice = self.saved()
        self.browser.keys("Control", "z")
        self.assertTrue(self.close(self.saved(), moved))
        self.browser.keys("Control", "z")
        self.assertTrue(self.close(self.saved(), begun))
        self.browser.keys("Control", "y")
        self.browser.keys("Control", "y")
        self.assertTrue(self.close(self.saved(), twice))
        self.browser.reload()
        self.ready()
        self.assertTrue(self.close(self.shown(), twice), "a reload loses nothing")
        self.browser.click("#undo")
        self.assertTrue(self.close(self.saved(), moved), "nor what may be undone")
        self.picture("drag")

    def test_mirrored_pairs_groups_and_the_whole_face(self):
        begun = self.shown()
        self.browser.keys("m")
        self.drag(4, -24, 12)
        mirrored = self.saved()
        shift = [mirrored[4][0] - begun[4][0], mirrored[4][1] - begun[4][1]]
        self.assertLess(shift[0], -1)
        self.assertLess(math.dist(mirrored[5], [begun[5][0] - shift[0], begun[5][1] + shift[1]]), 0.05)
        self.assertTrue(self.close([mirrored[i] for i in (0, 1, 2, 3, 6, 7)], [begun[i] for i in (0, 1, 2, 3, 6, 7)]))
        self.browser.keys("m")
        self.browser.keys("2")
        self.drag(6, 16, -16)
        grouped = self.saved()
        for i in range(8):
            moved = math.dist(grouped[i], mirrored[i])
            self.assertEqual(moved > 1, i in (4, 5, 6), NAMES[i])
        self.browser.keys("3")
        self.drag(2, 30, 18)
        whole = self.saved()
        first = [whole[0][0] - grouped[0][0], whole[0][1] - grouped[0][1]]
        self.assertTrue(self.close(whole, [[x + first[0], y + first[1]] for x, y in grouped], 0.05))
        self.drag(1, 25, -40, "Shift")
        turned = self.saved()
        sizes = [math.dist(turned[i], turned[j]) / math.dist(whole[i], whole[j]) for i in range(8) for j in range(i)]
        self.assertLess(max(sizes) - min(sizes), 0.01, "a similarity keeps all proportions")
        self.assertNotAlmostEqual(sizes[0], 1, 1)
        angle = lambda p: math.atan2(p[1][1] - p[0][1], p[1][0] - p[0][0])
        self.assertLess(angle(turned), angle(whole) - 0.05)
        self.picture("whole")

    def test_keyboard_and_zoom(self):
        self.browser.run("document.getElementById('picture').focus()")
        begun = self.shown()
        for _ in range(3):
            self.browser.keys(".")
        self.browser.keys(",")
        self.browser.keys("ArrowRight")
        self.browser.keys("Shift", "ArrowDown")
        nudged = self.saved()
        self.assertTrue(self.close([nudged[2]], [[begun[2][0] + 0.5, begun[2][1] + 5]]))
        before, place = self.scale(), self.place(5)
        self.browser.wheel(place, -600)
        wait_for(lambda: self.scale() > 2 * before, "zooming in")
        self.assertLess(math.dist(self.place(5), place), 2, "what is under the pointer stays there")
        self.drag(5, 30, 0)
        zoomed = self.saved()
        self.assertAlmostEqual(zoomed[5][0] - nudged[5][0], 30 / self.scale(), delta=0.15)
        self.browser.drag((place[0], place[1] + 120), (place[0] - 50, place[1] + 120))
        self.assertTrue(self.close(self.shown(), zoomed), "beside the points the picture moves")
        self.browser.keys("0")
        self.assertAlmostEqual(self.scale(), before, 3)
        self.browser.keys("h")
        visibility = "return document.getElementById('marks').getAttribute('visibility')"
        self.assertEqual(self.browser.run(visibility), "hidden")
        self.browser.keys("h")
        self.browser.keys("PageDown")
        wait_for(lambda: self.browser.run("return current.index") == 1, "the next frame")
        self.browser.keys("PageUp")
        wait_for(lambda: self.browser.run("return current.index") == 0, "the frame before")
        self.ready()
        self.assertTrue(self.close(self.shown(), zoomed))

    def test_nothing_is_lost_when_the_server_is_killed(self):
        self.drag(0, -20, 10)
        before = self.saved()
        self.server.kill()
        self.drag(1, 20, 10)
        self.drag(6, 8, 8)
        wait_for(lambda: "does not answer" in self.status(), "the page to say that the server is gone")
        self.picture("killed")
        changed = self.shown()
        self.assertFalse(self.close(changed, before))
        self.server.start()
        wait_for(lambda: self.status() == "draft, saved", "the page to save what waited")
        self.assertTrue(self.close(self.saved(), changed))
        for burst in range(3):
            for step in range(25):
                self.browser.keys("ArrowRight")
                if step == 11:
                    self.server.kill()
                    self.server.start()
            wait_for(lambda: self.status() == "draft, saved", "the page to save what waited")
            self.saved()
        self.assertAlmostEqual(self.shown()[6][0] - changed[6][0], 3 * 25 * 0.5, delta=0.05)
        self.server.kill()
        self.server.start()
        last = self.shown()
        self.browser.reload()
        self.ready()
        self.assertTrue(self.close(self.shown(), last), "and all is there after a kill and a reload")
        self.assertEqual([f.name for f in (self.folder / "annotated").rglob("*part*")], [])

    def test_two_windows_show_the_same(self):
        first = self.browser.windows()[0]
        second = self.browser.new_window()
        self.browser.switch(second)
        self.open()
        self.browser.switch(first)
        self.drag(6, 30, 10)
        changed = self.saved()
        self.browser.switch(second)
        wait_for(lambda: self.close(self.shown(), changed), "the other window to follow")
        # A change made before the window has seen another: told, and not lost.
        key = self.browser.run("return current.key")
        state = self.server.get(f"api/frames/{key}")
        other = [[x + 3, y] for x, y in state["points"]]
        self.browser.run("frames[current.index].tag = 'of old'")
        self.server.put(key, other, False, state["tag"])
        self.browser.keys("ArrowDown")
        wait_for(lambda: "another window" in self.status() or self.close(self.shown(), other), "the conflict")
        self.assertTrue(self.close(self.saved(), other))
        self.browser.keys("Control", "z")
        mine = self.saved()
        self.assertAlmostEqual(mine[6][0], changed[6][0], delta=0.02)
        self.browser.close_window()
        self.browser.switch(first)
        wait_for(lambda: self.close(self.shown(), mine), "the first window to follow")

    def file(self, ending):
        frame = self.server.get("api/project")["frames"][self.browser.run("return current.index")]
        return self.folder / "annotated" / frame["clip"] / f"{frame['number']:06}{ending}"

    def listed(self):
        return self.browser.run("return [...document.querySelectorAll('#frames button')].map(b => b.textContent)")

    def test_a_page_of_other_frames_takes_the_new_ones(self):
        before, scheme = self.listed(), self.server.arguments[-2:]
        manifest = str(self.folder / "manifest.json")
        self.drag(6, 10, 0)
        self.saved()
        self.server.stop()
        self.server.start(manifest, "--frames", "2", "--seed", "7", *scheme)
        names = [f"{f['clip']} · {f['number']}" for f in self.server.get("api/project")["frames"]]
        self.assertNotEqual(names, before)
        wait_for(lambda: self.listed() == names, "the page to take the new frames")
        self.ready()
        self.drag(7, 10, 0)
        self.saved()

    def test_no_change_reaches_another_project(self):
        (self.folder / "other.json").write_text(json.dumps({"rate": 25, "clips": [
            {"id": "clip", "video": "clip", "audio": "a.wav"}]}))
        scheme = self.server.arguments[-2:]
        self.server.kill()
        self.drag(6, 10, 0)
        changed = self.shown()
        self.server.start(str(self.folder / "other.json"), "--frames", "5", *scheme)
        wait_for(lambda: "other frames now; what is not saved waits here" in self.status(), "the page to tell")
        self.drag(7, 10, 0)
        changed = self.shown()
        self.picture("other")
        wait_for(lambda: "what is not saved waits here" in self.status(), "the page to tell")
        self.assertEqual([f for f in (self.folder / "other-annotated").rglob("*") if f.is_file()], [])
        self.browser.reload()
        self.ready()
        self.assertIn("mean shape", self.status(), "a reload takes the new frames")
        self.server.stop()
        self.server.start()
        wait_for(lambda: self.status() == "draft, saved", "what waited to be saved, once its frames are there again")
        self.assertTrue(self.close(self.saved(), changed))

    def test_a_broken_file_is_told_and_begun_anew(self):
        file = self.file(".pts")
        file.parent.mkdir(exist_ok=True)
        file.write_text("{\n1 x\n}\n")
        (file.parent / "999999.pts").write_text(file.read_text())
        wait_for(lambda: "a number is expected" in self.status(), "the page to tell what is wrong")
        self.server.stop()
        self.server.start()
        wait_for(lambda: len(self.listed()) == 6, "the page to list the frame that is none")
        self.ready()
        self.assertIn("a change begins the frame anew", self.status())
        self.picture("broken")
        self.browser.keys("PageUp")
        wait_for(lambda: "the clip has the frames 0 to 5" in self.status(), "the page to tell what is wrong")
        self.browser.keys("PageDown")
        self.ready()
        self.drag(6, 10, 0)
        self.saved()
        self.assertEqual(file.with_name(file.name + ".broken").read_text(), "{\n1 x\n}\n")
        self.browser.keys("PageDown")
        self.ready()
        self.drag(6, 10, 0)
        self.saved()

    def test_what_cannot_be_written_waits(self):
        blocked = self.folder / "annotated" / "clip"
        blocked.write_text("no folder")
        self.drag(6, 10, 0)
        wait_for(lambda: "what is not saved waits here" in self.status(), "the page to tell")
        self.assertIn("clip", self.status())
        blocked.unlink()
        wait_for(lambda: self.status() == "draft, saved", "the page to save what waited")
        self.saved()

    def test_frames_are_done_one_after_the_other(self):
        frames = self.server.get("api/project")["frames"]
        self.assertEqual(len(frames), 5)
        for done in range(3):
            index = self.browser.run("return current.index")
            self.assertEqual(index, done)
            points = truth(frames[index]["number"])
            self.browser.run("change(arguments[0])", points)
            self.browser.keys("Enter")
            wait_for(lambda: self.browser.run("return current.index") == done + 1, "the next frame")
            self.ready()
            file = self.folder / "annotated" / "clip" / f"{frames[index]['number']:06}.pts"
            wait_for(file.exists, "the frame to be done")
            self.assertTrue(self.close(read_points(file), points))
        self.assertEqual(self.browser.run("return document.getElementById('progress').textContent"), "3 of 5 done")
        self.assertIn("model's own fit", self.status())
        fitted, true = self.shown(), truth(frames[3]["number"])
        error = math.sqrt(sum(math.dist(a, b) ** 2 for a, b in zip(fitted, true)) / 8)
        self.assertLess(error, 4, "the model's fit lies near the truth")
        self.picture("model")
        # A point outside the picture: the frame cannot be done.
        self.browser.run("change(current.points.map((p, i) => i === 7 ? [p[0], size[1] + 5] : p))")
        self.browser.keys("Enter")
        wait_for(lambda: "point 7 lies outside the picture" in self.status(), "a refusal")
        self.assertEqual(self.browser.run("return current.index"), 3)
        self.browser.keys("r")
        wait_for(lambda: self.close(self.shown(), fitted), "the frame to begin afresh")
        self.saved()
        # Done is not for ever.
        self.browser.keys("PageUp")
        self.ready()
        self.browser.click("#reopen")
        wait_for(lambda: (self.kept() or [""])[0].endswith(".draft"), "the frame to be a draft again")
        self.assertEqual(self.server.stop(), 0)
        self.server.start()
        self.assertEqual(self.server.get("api/project")["frames"], frames, "the same frames after a restart")
        self.open()
        self.assertEqual(self.browser.run("return document.getElementById('progress').textContent"), "2 of 5 done")

    def test_the_page_keeps_to_its_own_rules(self):
        for key in ("m", "2", "h", "h", "PageDown"):
            self.browser.keys(key)
        self.ready()
        self.browser.keys("ArrowLeft")
        self.saved()
        severe = [entry["message"] for entry in self.browser.log() if entry["level"] == "SEVERE"]
        self.assertEqual([m for m in severe if "favicon" not in m], [])


if __name__ == "__main__":
    missing = [name for name, path in zip(("chromium", "chromedriver"), programs()) if not path]
    if missing:
        print(f"SKIPPED: the page is not tested, {' and '.join(missing)} not found (Debian: chromium, chromium-driver)")
        sys.exit(77)
    PROGRAM = sys.argv[1]
    PICTURES = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else None
    unittest.main(argv=[sys.argv[0]], verbosity=2)
