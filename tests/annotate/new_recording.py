"""The path of a person with a new recording, driven through the page in a real browser and timed.

new_recording.py path/to/talkgraph GRID folder [--clips 24] [--frames 20] [--train]    (the folder is made)

Validation clips of a folder of the GRID corpus (docs/grid.md) stand for the recording: videos with transcripts, nothing
else. The hand, which knows the landmarks that came with them, drags the whole face, then groups, then points, until
nothing is further than --within pixels from them.
"""

import argparse
import csv
import json
import math
import pathlib
import resource
import shutil
import statistics
import subprocess
import tempfile
import time

from browser import Browser, Server, wait_for
from new_speaker import read_points, rms

PIPELINES = pathlib.Path(__file__).parents[2] / "pipelines"


def record(grid, folder, clips):
    folder.mkdir(parents=True)
    for name in json.loads((grid / "split.json").read_text())["validation"][:clips]:
        shutil.copy(grid / "video" / f"{name}.mpg", folder)
        words = [line.split()[2] for line in (grid / "align" / f"{name}.align").read_text().splitlines()]
        (folder / f"{name}.txt").write_text(" ".join(word for word in words if word not in ("sil", "sp")))


def landmarks(grid, clip):
    """Of every frame, as they came with a clip."""
    with open(grid / "landmarks" / f"{clip}.csv") as file:
        rows = [[float(value) for value in row[1:]] for row in list(csv.reader(file))[1:]]
    return [list(zip(row[::2], row[1::2])) for row in rows]


def centre(points):
    return [statistics.fmean(axis) for axis in zip(*points)]


class Hand:
    """Drags points of the frame that is open."""

    def __init__(self, browser, scheme, within):
        self.browser, self.scheme, self.within = browser, scheme, within
        self.whole = self.groups = self.points = 0

    def shown(self):
        return self.browser.run("return current.points")

    def drag(self, start, to, modifier=None):
        window = "const b = document.getElementById('picture').getBoundingClientRect();" \
                 "return arguments[0].map(([x, y]) => [b.x + view.x + view.scale * x, b.y + view.y + view.scale * y])"
        before = self.shown()
        self.browser.drag(*self.browser.run(window, [start, to]), modifier)
        wait_for(lambda: self.shown() != before or math.dist(start, to) < 0.5, "points to move")

    def place_face(self, truth):
        self.browser.keys("3")
        shown = self.shown()
        here, there = centre(shown), centre(truth)
        if math.dist(here, there) > 3:
            self.drag(shown[30], [p + b - a for p, a, b in zip(shown[30], here, there)])
            self.whole += 1
        size = lambda points: math.sqrt(statistics.fmean(math.dist(p, centre(points)) ** 2 for p in points))
        shown = self.shown()
        ratio = size(truth) / size(shown)
        if abs(ratio - 1) > 0.04:
            middle = centre(shown)
            self.drag(shown[8], [m + ratio * (p - m) for p, m in zip(shown[8], middle)], "Shift")
            self.whole += 1

    def place_groups(self, truth):
        self.browser.keys("2")
        for group in self.scheme["groups"]:
            shown, points = self.shown(), group["points"]
            here, there = centre([shown[p] for p in points]), centre([truth[p] for p in points])
            if math.dist(here, there) < 2:
                continue
            self.drag(shown[points[1]], [p + b - a for p, a, b in zip(shown[points[1]], here, there)])
            self.groups += 1

    def place_points(self, truth):
        self.browser.keys("1")
        for p, (here, there) in enumerate(zip(self.shown(), truth)):
            if math.dist(here, there) > self.within:
                self.drag(here, there)
                self.points += 1

    def mark(self, truth):
        self.place_face(truth)
        self.place_groups(truth)
        self.place_points(truth)
        return rms(self.shown(), truth)


def annotate(program, manifest, grid, frames, within):
    start = time.monotonic()
    server = Server(program, str(manifest), "--frames", str(frames))
    profile = tempfile.TemporaryDirectory(prefix="talkgraph-profile-", ignore_cleanup_errors=True)
    browser = Browser(profile.name)
    ready = lambda: browser.run("return typeof current !== 'undefined' && !!ready()")
    try:
        project = server.get("api/project")
        hand = Hand(browser, project["scheme"], within)
        browser.open(server.url)
        wait_for(ready, "the page")
        print(f"annotate: the first frame is there after {time.monotonic() - start:.1f} s")
        print("| frame | begins | face drags | group drags | point drags | left | next frame after |")
        print("|---|---|---|---|---|---|---|")
        for n, frame in enumerate(project["frames"], 1):
            truth = landmarks(grid, frame["clip"])[frame["number"]]
            by, before = browser.run("return current.by"), (hand.whole, hand.groups, hand.points)
            left = hand.mark(truth)
            pressed = time.monotonic()
            browser.keys("Enter")
            done = f"{n} of {len(project['frames'])} done"
            wait_for(lambda: browser.run("return document.getElementById('progress').textContent") == done, done)
            wait_for(ready, "the next frame")
            drags = [now - then for now, then in zip((hand.whole, hand.groups, hand.points), before)]
            took = time.monotonic() - pressed
            print(f"| {n} | {by} | {' | '.join(map(str, drags))} | {left:.2f} px | {took:.2f} s |", flush=True)
        print(f"drags: {hand.whole} of the face, {hand.groups} of groups, {hand.points} of points; "
              f"{time.monotonic() - start:.0f} s with a hand that takes no time")
    finally:
        browser.quit()
        assert server.stop() == 0
        profile.cleanup()


def timed(*command):
    """Of the processor: what other programs of the computer do counts for the wall clock only."""
    start, before = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([str(part) for part in command], check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    processor = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    print(f"{' '.join(map(str, command[1:3]))}: {time.monotonic() - start:.1f} s, {processor:.1f} s of processor time",
          flush=True)


def compare(grid, tracked):
    errors = []
    for clip in tracked.iterdir():
        truth = landmarks(grid, clip.name)
        errors += [rms(read_points(file), truth[int(file.stem)]) for file in clip.glob("*.pts")]
    print(f"followed: {len(errors)} frames, from the landmarks that came with the clips "
          f"{statistics.median(errors):.2f} px (median), {max(errors):.2f} px (worst)")


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("program")
    options.add_argument("grid", type=pathlib.Path)
    options.add_argument("folder", type=pathlib.Path)
    options.add_argument("--clips", type=int, default=24)
    options.add_argument("--frames", type=int, default=20)
    options.add_argument("--within", type=float, default=1.5, help="pixels from the landmarks that are near enough")
    options.add_argument("--train", action="store_true", help="run pipelines/track-own.json and own.json")
    options = options.parse_args()
    record(options.grid, options.folder, options.clips)
    manifest = options.folder / "manifest.json"
    timed(options.program, "corpus", "new", options.folder)
    timed(options.program, "corpus", "check", manifest)
    annotate(options.program, manifest, options.grid, options.frames, options.within)
    timed(options.program, "corpus", "check", manifest)
    for name in ("track-own", "own") if options.train else ():
        timed(options.program, "run", PIPELINES / f"{name}.json", "-q", "--set", f"manifest={manifest}", "-o",
              options.folder / name)
    if options.train:
        compare(options.grid, options.folder / "track-own" / "landmarks")


if __name__ == "__main__":
    main()
