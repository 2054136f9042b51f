"""The page of report.latent in a real browser: latent_browser_test.py path/to/talkgraph [folder for pictures of it]"""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

REPOSITORY = pathlib.Path(__file__).parents[3]
sys.path.insert(0, str(REPOSITORY / "tests" / "annotate"))
from browser import Browser, programs, wait_for

TITLE = "<script>document.title = 'run'</script> & \"sound\""
GRAPH = {"nodes": {
    "texts": {"type": "voice.recordings", "params": {"texts": ["Bob may buy a blue boat."]}},
    "parts": {"type": "corpus.parts", "in": {"recording": "texts"}},
    "sound": {"graph": str(REPOSITORY / "pipelines/fragments/speech.json"), "in": {"audio": "parts.audio"}},
    "labels": {"type": "phones.label_frames", "in": {"phones": "parts.phones", "like": "sound.track"}},
    "gpdm": {"type": "latent.gpdm", "in": {"tracks": "sound.track"},
             "params": {"latent_dimension": 3, "iterations": 20}},
    "page": {"type": "report.latent", "in": {"model": "gpdm", "labels": "labels.labels", "paths": {}, "states": {}},
             "params": {"title": TITLE}}}}


class LatentPageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory(prefix="talkgraph-latent-", ignore_cleanup_errors=True)
        cls.addClassCleanup(temporary.cleanup)
        folder = pathlib.Path(temporary.name)
        (folder / "graph.json").write_text(json.dumps(GRAPH))
        subprocess.run([PROGRAM, "run", "graph.json", "-o", "run", "--no-cache"], cwd=folder, check=True,
                       stdout=subprocess.DEVNULL)
        cls.page = folder / "run" / "latent-space.html"
        cls.browser = Browser(folder / "profile", (1100, 800))
        cls.addClassCleanup(cls.browser.quit)

    def setUp(self):
        self.browser.open(self.page.as_uri())
        wait_for(lambda: self.drawn() > 1000, "the space to be drawn")

    def run_in_page(self, script, *arguments):
        return self.browser.run(f"return {script}", *arguments)

    def drawn(self):
        """Pixels of the canvas that are not empty."""
        return self.run_in_page("(() => { const { width, height } = canvas;"
                                "const pixels = brush.getImageData(0, 0, width, height).data; let count = 0;"
                                "for (let i = 3; i < pixels.length; i += 4) count += pixels[i] > 0; return count })()")

    def coloured(self, phone):
        """Pixels in the colour of a phone."""
        return self.run_in_page("(() => { const n = parseInt(data.phones[arguments[0]].colour.slice(1), 16);"
                                "const pixels = brush.getImageData(0, 0, canvas.width, canvas.height).data;"
                                "let count = 0;"
                                "for (let i = 0; i < pixels.length; i += 4) count += pixels[i] === n >> 16 &&"
                                "  pixels[i + 1] === (n >> 8 & 255) && pixels[i + 2] === (n & 255);"
                                "return count })()", phone)

    def view(self):
        return self.run_in_page("({ ...view })")

    def status(self):
        return self.run_in_page("$('status').textContent")

    def place(self, frame):
        """Of a frame in the window."""
        return self.run_in_page("(() => { const box = canvas.getBoundingClientRect();"
                                "const p = camera()(points[arguments[0]]);"
                                "return [box.x + p.x, box.y + p.y] })()", frame)

    def middle(self):
        return self.run_in_page("(() => { const b = canvas.getBoundingClientRect();"
                                "return [b.x + b.width / 2, b.y + b.height / 2] })()")

    def settle(self):
        wait_for(lambda: self.run_in_page("!waiting"), "the page to be drawn")

    def test_opens_whole_and_says_what_it_shows(self):
        self.assertEqual(self.run_in_page("document.title"), TITLE, "a title is text")
        self.assertEqual([entry["message"] for entry in self.browser.log() if entry["level"] == "SEVERE"], [])
        self.assertEqual(self.run_in_page("performance.getEntriesByType('resource').length"), 0)
        self.assertIn("phones", self.run_in_page("canvas.getAttribute('aria-label')"))
        rows = self.run_in_page("[...document.querySelectorAll('#numbers tbody tr')]"
                                ".map((row) => row.cells[1].textContent)")
        self.assertEqual([int(row) for row in rows], self.run_in_page("data.phones.map(({ count }) => count)"))
        self.picture("opened")

    def test_turns_and_zooms(self):
        x, y = self.middle()
        before = self.view()
        self.browser.drag((x, y), (x + 150, y + 60))
        after = self.view()
        self.assertAlmostEqual(after["turn"] - before["turn"], 1, delta=0.05)
        self.assertAlmostEqual(after["tilt"] - before["tilt"], 0.4, delta=0.05)
        self.browser.wheel((x, y), -250)
        wait_for(lambda: self.view()["zoom"] > 1.5, "the wheel to zoom")
        self.settle()
        self.picture("turned")
        self.run_in_page("canvas.focus()")
        for key, name, change in (("ArrowLeft", "turn", -0.1), ("ArrowUp", "tilt", -0.1)):
            before = self.view()[name]
            self.browser.keys(key)
            self.assertAlmostEqual(self.view()[name] - before, change, 6)
        self.browser.click("#reset")
        self.assertEqual(self.view(), self.run_in_page("start"))

    def test_zooms_by_two_fingers(self):
        x, y = self.middle()
        finger = lambda name, side: {"type": "pointer", "id": name, "parameters": {"pointerType": "touch"}, "actions": [
            {"type": "pointerMove", "duration": 0, "x": round(x + 50 * side), "y": round(y)},
            {"type": "pointerDown", "button": 0},
            {"type": "pointerMove", "duration": 100, "x": round(x + 100 * side), "y": round(y)},
            {"type": "pointerUp", "button": 0}]}
        self.browser.actions(finger("left", -1), finger("right", 1))
        self.assertAlmostEqual(self.view()["zoom"], 2, delta=0.1)
        self.assertEqual(self.view()["turn"], self.run_in_page("start.turn"), "fingers that part do not turn it")

    def test_tells_of_the_frame_pointed_at(self):
        frame = self.run_in_page("data.label.length >> 1")
        x, y = self.place(frame)
        self.browser.actions({"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"}, "actions": [
            {"type": "pointerMove", "duration": 0, "x": round(x), "y": round(y)}]})
        wait_for(lambda: self.status().startswith("Frame"), "a frame to be told of")
        told = self.run_in_page("current")
        self.assertLess(max(abs(a - b) for a, b in zip(self.place(told), (x, y))), 12)
        self.assertIn(f": {self.run_in_page('data.labels[data.label[current]]')}, number", self.status())
        self.settle()
        self.picture("pointed")

    def test_goes_from_frame_to_frame_by_keys(self):
        self.run_in_page("canvas.focus()")
        for expected in (1, 2, 3):
            self.browser.keys("PageDown")
            self.assertTrue(self.status().startswith(f"Frame {expected}:"), self.status())
        self.browser.keys("PageUp")
        self.assertTrue(self.status().startswith("Frame 2:"), self.status())

    def test_legend_hides_phones(self):
        self.browser.click("#cloud")
        self.settle()
        self.assertGreater(self.coloured(0), 20)
        self.browser.click("#legend li:first-child input")
        self.settle()
        self.assertEqual(self.coloured(0), 0)
        self.browser.click("#none")
        self.settle()
        alone = self.drawn()
        self.browser.click("#all")
        self.settle()
        self.assertGreater(self.coloured(0), 20)
        self.assertGreater(self.drawn(), alone, "the box alone is less")

    def test_fills_whatever_window(self):
        fits = "Math.abs(canvas.width / canvas.height - canvas.clientWidth / canvas.clientHeight) < 0.01"
        for width, height in ((500, 900), (1100, 800)):
            self.browser.ask("POST", "/window/rect", {"width": width, "height": height})
            wait_for(lambda: self.run_in_page(f"innerWidth <= {width} && !waiting && {fits}"), "the space to fit")
            self.settle()
            self.picture(f"{width} wide")

    def test_cloud_follows_its_slider(self):
        with_cloud = self.drawn()
        self.browser.run("$('density').value = 0; $('density').dispatchEvent(new Event('input'))")
        self.settle()
        self.assertLess(self.drawn(), with_cloud)

    def picture(self, name):
        if PICTURES:
            PICTURES.mkdir(parents=True, exist_ok=True)
            self.browser.screenshot(PICTURES / f"{name}.png")


if __name__ == "__main__":
    missing = [name for name, path in zip(("chromium", "chromedriver"), programs()) if not path]
    if missing:
        print(f"SKIPPED: the page is not tested, {' and '.join(missing)} not found (Debian: chromium, chromium-driver)")
        sys.exit(77)
    PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
    PICTURES = pathlib.Path(sys.argv[2]).resolve() if len(sys.argv) > 2 else None
    unittest.main(argv=[sys.argv[0]], verbosity=2)
