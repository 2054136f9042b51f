"""Taking a study in a real browser: browser_test.py path/to/talkgraph STUDY [folder for pictures [test...]]

STUDY is path/to/write_small_study, or the folder of a study that `talkgraph study make` made, which is copied."""

import json
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.request

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "annotate"))
from browser import KEYS, Browser, programs, wait_for

KEYS.update({"Space": " ", "Tab": "\ue004"})


class Server:
    """talkgraph study serve; a restart takes the port that it had."""

    def __init__(self, folder):
        self.folder, self.port = folder, 0
        self.start()

    def start(self, *arguments):
        command = [PROGRAM, "study", "serve", str(self.folder), "--port", str(self.port), *arguments]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.links = dict(self.process.stdout.readline().split() for _ in range(2 + len(arguments) // 2))
        self.port = int(self.links["start"].split(":")[2].split("/")[0])

    def kill(self):
        self.process.kill()
        self.process.wait()
        self.process.stdout.close()

    def stop(self):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(10)
        self.process.stdout.close()

    def report(self, path=""):
        with urllib.request.urlopen(self.links["report"] + path) as answer:
            return json.load(answer)

    def answers(self):
        return self.report("/answers.json")


class StudyTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory(prefix="talkgraph-study-")
        cls.addClassCleanup(temporary.cleanup)
        cls.study = pathlib.Path(temporary.name) / "study"
        if STUDY.is_dir():
            shutil.copytree(STUDY, cls.study, ignore=shutil.ignore_patterns("answers.db*"))
        else:
            cls.study.mkdir()
            subprocess.run([str(STUDY), str(cls.study)], check=True)
        study = json.loads((cls.study / "study.json").read_text())
        cls.profile = {question["id"]: 1 for question in study["profile"]}
        cls.questions = {clip["id"]: [question["id"] for question in test["questions"]]
                         for test in study["tests"] for clip in test["clips"]}
        cls.tests = {clip["id"]: test["id"] for test in study["tests"] for clip in test["clips"]}
        categories = lambda test: {(c["speaker"], c["synthetic"], c["eyes"]) for c in test["clips"]}
        shown = {test["id"]: test["per_category"] * len(categories(test)) for test in study["tests"]}
        cls.clips = sum(shown.values())
        cls.answers = sum(shown[test["id"]] * len(test["questions"]) for test in study["tests"])

    def setUp(self):
        for file in self.study.glob("answers.db*"):
            file.unlink()
        self.server = Server(self.study)
        self.addCleanup(lambda: self.server.process.poll() is None and self.server.kill())
        profile = tempfile.TemporaryDirectory(prefix="talkgraph-profile-", ignore_cleanup_errors=True)
        self.addCleanup(profile.cleanup)
        self.browser = Browser(profile.name, (900, 900))
        self.addCleanup(self.browser.quit)
        self.given, self.screen = [], ""

    # What the page shows.
    def value(self, expression):
        return self.browser.run(f"return {expression}")

    def page(self):
        return self.value("sections.find((name) => !$(name).hidden)")

    def wait_page(self, name):
        wait_for(lambda: self.page() == name, f"the page {name}")

    def status(self):
        return self.value("$('status').textContent")

    def clip(self):
        return self.value("note?.clip")

    def locked(self):
        return self.value("$('lock').disabled")

    def which(self):
        return self.tests[self.clip()]

    def picture(self, name):
        if PICTURES:
            self.browser.screenshot(PICTURES / f"{self.screen}{name}.png")

    # What a person does.
    def begin(self, link):
        self.browser.open(link)
        self.wait_page("consent")
        self.picture("consent")
        self.assertLessEqual(*self.value("[document.documentElement.scrollWidth, innerWidth]"))
        self.browser.click("#agree")
        self.wait_page("profile")
        self.picture("profile")
        for question, option in self.profile.items():
            self.browser.click(f"input[name=profile-{question}][value='{option}']")
        self.browser.click("#profile-form button")
        self.wait_page("intro")

    def seen(self):
        self.wait_page("clip")
        wait_for(lambda: not self.locked(), "the clip to have run to its end")

    def option(self, question):
        """What this person answers: known of each clip and question, so that it can be found again."""
        options = self.value(f'document.querySelectorAll(`input[name="{self.clip()}-{question}"]`).length')
        return sum(map(ord, self.clip() + question)) % options

    def answer_by_mouse(self):
        for question in self.questions[self.clip()]:
            self.browser.click(f"input[name='{self.clip()}-{question}'][value='{self.option(question)}']")

    def answer_by_keys(self):
        for question in self.questions[self.clip()]:
            self.browser.keys(str(self.option(question) + 1))

    def note_answers(self, plays):
        for question in self.questions[self.clip()]:
            self.given.append((self.clip(), question, self.option(question), plays))

    def next_by_mouse(self):
        self.browser.click("#next")

    def replay(self, count, by_keys):
        for _ in range(count):
            plays = self.value("note.plays")
            self.browser.keys("Space") if by_keys else self.browser.click("#replay")
            wait_for(lambda: self.value("note.plays") == plays + 1, "the clip to have run again")

    def moved_on(self, clip):
        wait_for(lambda: self.page() != "clip" or self.clip() not in (None, clip), "what comes next")

    def take_clip(self, by_keys, replays=0):
        self.seen()
        clip = self.clip()
        self.replay(replays, by_keys)
        self.answer_by_keys() if by_keys else self.answer_by_mouse()
        self.note_answers(1 + replays)
        self.browser.keys("Enter") if by_keys else self.next_by_mouse()
        self.moved_on(clip)

    def kept(self):
        return [(a["clip"], a["question"], a["option"], a["plays"]) for a in self.server.answers()["answers"]]

    def check_all(self):
        """No answer is lost, doubled or changed."""
        self.wait_page("done")
        self.picture("done")
        everything = self.server.answers()
        (person,) = everything["participants"]
        self.assertEqual(person["profile"], self.profile)
        self.assertGreater(person["finished"], 0)
        answers = everything["answers"]
        self.assertEqual(len(answers), self.answers)
        self.assertEqual(self.kept(), self.given)
        order = [a["test"] for a in answers]
        self.assertEqual(list(dict.fromkeys(order)), person["tests"])
        self.assertEqual(order, sorted(order, key=person["tests"].index), "a test is over before the next begins")
        for answer in answers:
            self.assertGreater(answer["seconds"], 0.8, "the clip takes as long")
        self.assertEqual(self.server.report(), {"invited": 1, "started": 1, "finished": 1, "answers": self.answers})

    def test_by_mouse(self):
        self.begin(self.server.links["start"])
        self.assertIn("/p/", self.value("location.pathname"))
        for number in range(self.clips):
            if self.page() == "intro":
                self.picture(f"intro-{number}")
                self.browser.click("#begin")
            self.seen()
            test = self.which()
            if self.value("state.test.position") == 1:
                self.answer_by_mouse()
                self.picture(test)
            self.take_clip(False, replays=1 if number % 5 == 2 else 0)
        self.check_all()
        self.browser.reload()
        self.wait_page("done")
        severe = [entry["message"] for entry in self.browser.log() if entry["level"] == "SEVERE"]
        self.assertEqual([m for m in severe if "favicon" not in m], [], "the page keeps to its own rules")

    def test_by_keys_with_a_reload_and_a_kill_in_the_middle_of_each_test(self):
        self.server.stop()
        self.server.start("--invite", "1")
        link = self.server.links["invite"]
        self.begin(link)
        while self.page() != "done":
            if self.page() == "intro":
                self.browser.keys("Enter")
            self.seen()
            position = self.value("state.test.position")
            if position == 1:
                self.reload_in_the_middle()
            elif position == 2:
                self.killed_while_saving(reload=len(self.given) < self.answers / 2)
            else:
                self.take_clip(True, replays=position % 2)
        self.check_all()

    def test_what_does_not_come_from_the_server_is_no_answer(self):
        self.begin(self.server.links["start"])
        self.browser.click("#begin")
        self.seen()
        clip = self.clip()
        self.answer_by_mouse()
        self.note_answers(1)
        self.browser.run("""const real = fetch, others = [new Response("", { status: 400 }),
          new Response("<h1>Too many requests</h1>", { status: 429, headers: { "Content-Type": "text/html" } })];
          window.fetch = (...asked) => others.length ? Promise.resolve(others.shift()) : real(...asked);""")
        self.next_by_mouse()
        wait_for(lambda: "Not saved yet" in self.status(), "the page to tell")
        self.moved_on(clip)
        self.assertEqual(self.kept(), self.given)

    def label(self, selector):
        """The name that a screen reader tells."""
        element = self.browser.ask("POST", "/element", {"using": "css selector", "value": selector})
        return self.browser.ask("GET", f"/element/{next(iter(element.values()))}/computedlabel")

    def test_on_a_phone_and_for_screen_readers(self):
        self.screen = "phone-"
        phone = {"Emulation.setTouchEmulationEnabled": {"enabled": True},
                 "Emulation.setDeviceMetricsOverride": {"width": 360, "height": 740, "deviceScaleFactor": 1,
                                                        "mobile": True}}
        for command, parameters in phone.items():
            self.browser.ask("POST", "/goog/cdp/execute", {"cmd": command, "params": parameters})
        self.begin(self.server.links["start"])
        self.assertTrue(self.value("document.activeElement.matches('#intro h2')"), "what is new is read out")
        while self.value("state.test.questions.length") == 1:
            self.browser.click("#begin")
            while self.page() == "clip":
                self.take_clip(False)
        self.browser.click("#begin")
        self.wait_page("clip")
        self.assertTrue(self.value("document.activeElement.id === 'stage'"))
        self.assertRegex(self.label("#stage"), "Clip 1 of [0-9]+")
        self.assertIn(f"of {self.clips} clips answered", self.label("#progress"))
        self.seen()
        self.assertEqual(self.status(), "Please answer.")
        # A browser tells screen readers of a change when it has time.
        first = self.value("state.test.questions[0]")
        wait_for(lambda: self.label(".question:focus") == first["text"], "the question's name")
        wait_for(lambda: [self.label(f"#questions input[value='{i}']") for i in range(len(first["options"]))]
                 == first["options"], "the options' names")
        self.assertEqual(self.value("$('status').getAttribute('role')"), "status")
        self.assertLessEqual(self.value("document.documentElement.scrollWidth"), 360)
        heights = self.value("[...document.querySelectorAll('#clip .option, #clip button')].map(e => e.offsetHeight)")
        self.assertGreaterEqual(min(heights), 44, "a finger meets it")
        self.picture("perceptual")

    def reload_in_the_middle(self):
        """What was chosen and how often the clip ran is there again."""
        clip = self.clip()
        self.replay(2, True)
        self.answer_by_keys()
        self.browser.reload()
        self.wait_page("intro")
        self.assertEqual(self.value("$('begin').textContent"), "Go on")
        self.browser.keys("Enter")
        self.wait_page("clip")
        self.assertEqual(self.clip(), clip)
        self.assertFalse(self.locked())
        self.assertFalse(self.value("$('next').disabled"))
        wait_for(lambda: self.value("note.plays") >= 4, "the clip to have run once more")
        self.note_answers(4)
        self.browser.keys("Enter")
        self.moved_on(clip)
        self.seen()
        self.assertEqual(self.value("[note.plays, Object.keys(note.chosen).length]"), [1, 0], "of the next clip")

    def killed_while_saving(self, reload):
        """The page keeps the answer, also through a reload once the server is there again, and saves it once."""
        clip, before = self.clip(), self.kept()
        self.answer_by_keys()
        self.note_answers(1)
        self.server.kill()
        self.browser.keys("Enter")
        wait_for(lambda: "Not saved yet" in self.status(), "the page to tell")
        self.assertTrue(self.value("$('status').getBoundingClientRect().bottom <= innerHeight"), "where it is seen")
        self.picture("killed")
        self.server.start()
        self.assertEqual(self.kept()[:len(before)], before)
        if reload:
            self.browser.reload()
            self.wait_page("intro")
        self.moved_on(clip)


if __name__ == "__main__":
    missing = [name for name, path in zip(("chromium", "chromedriver"), programs()) if not path]
    if missing:
        print(f"SKIPPED: the page is not tested, {' and '.join(missing)} not found (Debian: chromium, chromium-driver)")
        sys.exit(77)
    PROGRAM, STUDY = sys.argv[1], pathlib.Path(sys.argv[2])
    PICTURES = pathlib.Path(sys.argv[3]) if len(sys.argv) > 3 else None
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]], verbosity=2)
