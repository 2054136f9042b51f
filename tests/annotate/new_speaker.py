"""How far a person's work goes: the built-in speaker's clips, whose landmarks are known, are annotated with some noise
through the page's interface, as docs/annotate.md describes it, and a talking face is trained on them.

new_speaker.py path/to/talkgraph folder [--frames 20] [--noise 0.7] [--train]
"""

import argparse
import json
import math
import pathlib
import random
import statistics
import subprocess
import time

from browser import Server

SENTENCES, HELD_OUT, TESTED = 24, 4, 20
EXPORT = {"nodes": {
    "recordings": {"type": "speaker.builtin", "params": {"sentences": SENTENCES, "held_out": HELD_OUT}},
    "parts": {"type": "corpus.parts", "in": {"recording": "recordings"}},
    "labels": {"type": "write.labels", "in": {"phones": "parts.phones", "words": "parts.words"}},
    "points": {"type": "write.landmarks", "in": {"landmarks": "parts.landmarks"}},
    "clips": {"type": "write.clip", "in": {"video": "parts.video", "audio": "parts.audio"}}}}


def read_points(file):
    text = file.read_text().split("{")[1].split("}")[0].split()
    return [(float(x) - 1, float(y) - 1) for x, y in zip(text[::2], text[1::2])]


def rms(points, truth):
    return math.sqrt(statistics.fmean(math.dist(p, q) ** 2 for p, q in zip(points, truth, strict=True)))


def record(program, folder):
    """Clips, labels and true landmarks, and the manifest that a person would write."""
    if not (folder / "clips").exists():
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "export.json").write_text(json.dumps(EXPORT))
        subprocess.run([program, "run", "-q", folder / "export.json", "-o", folder, "--overwrite"], check=True)
    ids = sorted(file.stem for file in (folder / "clips").glob("*.mp4"))
    clips = [{"id": i, "video": f"clips/{i}.mp4", "phones": f"labels/{i}.TextGrid", "words": f"labels/{i}.TextGrid",
              "split": "train" if n < len(ids) - HELD_OUT else "test"} for n, i in enumerate(ids)]
    (folder / "manifest.json").write_text(json.dumps({"clips": clips}, indent=1))


def measure(server, frames, truth, wanted):
    """Of frames that are not annotated, how far their points to begin with are from the truth; and the time taken."""
    errors, lips, by, start = [], [], set(), time.monotonic()
    for f in wanted:
        begun = server.get(f"api/frames/{frames[f]['key']}")
        by.add(begun["by"])
        errors.append(rms(begun["points"], truth(frames[f])))
        lips.append(rms(begun["points"][48:], truth(frames[f])[48:]))
    return errors, lips, by, (time.monotonic() - start) / len(wanted)


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("program")
    options.add_argument("folder", type=pathlib.Path)
    options.add_argument("--frames", type=int, default=20)
    options.add_argument("--noise", type=float, default=0.7, help="standard deviation of x and of y, pixels")
    options.add_argument("--train", action="store_true", help="run pipelines/own.json on them")
    options = options.parse_args()
    record(options.program, options.folder)
    truth = lambda frame: read_points(options.folder / "landmarks" / frame["clip"] / f"{frame['number']:06}.pts")
    manifest = str(options.folder / "manifest.json")
    server = Server(options.program, manifest, "--frames", str(options.frames + TESTED))
    try:
        frames = server.get("api/project")["frames"]
        draw = random.Random(1)
        print("| frames done | begins with | all points: median | worst | lips: median | worst | s a frame |")
        print("|---|---|---|---|---|---|---|")
        for done in range(options.frames + 1):
            if done in (0, 1, 3, 5, 10, 15, 20):
                errors, lips, by, seconds = measure(server, frames, truth, range(options.frames, len(frames)))
                print(f"| {done} | {', '.join(sorted(by))} | {statistics.median(errors):.2f} px | {max(errors):.2f} px "
                      f"| {statistics.median(lips):.2f} px | {max(lips):.2f} px | {seconds:.2f} |", flush=True)
            if done < options.frames:
                slip = lambda: draw.gauss(0, options.noise)
                marked = [[x + slip(), y + slip()] for x, y in truth(frames[done])]
                server.put(frames[done]["key"], marked, True, server.get("api/frames")[done]["tag"])
    finally:
        server.stop()
    if options.train:
        pipeline = pathlib.Path(__file__).parents[2] / "pipelines" / "own.json"
        subprocess.run([options.program, "run", pipeline, "--set", f"manifest={manifest}",
                        "-o", options.folder / "trained", "--overwrite"], check=True)


if __name__ == "__main__":
    main()
