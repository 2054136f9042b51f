"""Headless Chromium, driven through chromedriver by the W3C WebDriver protocol; and the server under test."""

import base64
import json
import shutil
import signal
import socket
import subprocess
import time
import urllib.error
import urllib.request

KEYS = {"Enter": "\ue007", "Control": "\ue009", "Shift": "\ue008", "ArrowLeft": "\ue012", "ArrowUp": "\ue013",
        "ArrowRight": "\ue014", "ArrowDown": "\ue015", "PageUp": "\ue00e", "PageDown": "\ue00f", "Escape": "\ue00c"}


def programs():
    """Paths of Chromium and its driver; None where one is missing."""
    return shutil.which("chromium"), shutil.which("chromedriver")


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def wait_for(condition, what, seconds=15):
    """The first true value of a condition."""
    end = time.monotonic() + seconds
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > end:
            raise AssertionError(f"waited {seconds} s for: {what}")
        time.sleep(0.05)


class Server:
    """talkgraph annotate; a restart takes the port that it had."""

    def __init__(self, program, *arguments):
        self.program, self.arguments, self.port = program, arguments, 0
        self.start()

    def start(self, *arguments):
        """With other arguments, if some are given."""
        command = [self.program, "annotate", *(arguments or self.arguments)]
        self.process = subprocess.Popen([*command, "--port", str(self.port)], stdout=subprocess.PIPE, text=True)
        self.url = self.process.stdout.readline().strip()
        assert self.url, "the server did not start"
        self.port = int(self.url.rstrip("/").rsplit(":", 1)[1])

    def kill(self):
        self.process.kill()
        self.process.wait()
        self.process.stdout.close()

    def stop(self):
        self.process.send_signal(signal.SIGINT)
        code = self.process.wait(10)
        self.process.stdout.close()
        return code

    def get(self, path):
        with urllib.request.urlopen(self.url + path) as answer:
            return json.load(answer)

    def put(self, key, points, done, tag):
        request = urllib.request.Request(
            f"{self.url}api/frames/{key}", json.dumps({"points": points, "done": done}).encode(),
            {"Content-Type": "application/json", "If-Match": tag}, method="PUT")
        with urllib.request.urlopen(request) as answer:
            return json.load(answer)


class Browser:
    def __init__(self, profile, size=(1280, 860)):
        chromium, driver = programs()
        port = free_port()
        self.driver = subprocess.Popen([driver, f"--port={port}"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.base = f"http://127.0.0.1:{port}"
        self.session = ""
        wait_for(self.answers, "chromedriver")
        arguments = ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
                     "--disable-background-networking", f"--user-data-dir={profile}",
                     f"--window-size={size[0]},{size[1]}"]
        options = {"goog:chromeOptions": {"binary": chromium, "args": arguments},
                   "goog:loggingPrefs": {"browser": "ALL"}}
        made = self.call("POST", "/session", {"capabilities": {"alwaysMatch": options}})
        self.session = f"/session/{made['sessionId']}"

    def answers(self):
        try:
            return self.call("GET", "/status")["ready"]
        except OSError:
            return False

    def call(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.base + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=60) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise AssertionError(f"{method} {path}: {error.read().decode()}") from error

    def ask(self, method, path, body=None):
        return self.call(method, self.session + path, body)

    def quit(self):
        if self.session:
            self.ask("DELETE", "")
        self.driver.terminate()
        self.driver.wait()

    def open(self, url):
        self.ask("POST", "/url", {"url": url})

    def reload(self):
        self.ask("POST", "/refresh", {})

    def run(self, script, *arguments):
        return self.ask("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def windows(self):
        return self.ask("GET", "/window/handles")

    def new_window(self):
        return self.ask("POST", "/window/new", {"type": "tab"})["handle"]

    def switch(self, window):
        self.ask("POST", "/window", {"handle": window})

    def close_window(self):
        self.ask("DELETE", "/window")

    def log(self):
        return self.ask("POST", "/se/log", {"type": "browser"})

    def screenshot(self, file):
        with open(file, "wb") as out:
            out.write(base64.b64decode(self.ask("GET", "/screenshot")))

    def actions(self, *sources):
        self.ask("POST", "/actions", {"actions": list(sources)})

    def keys(self, *names):
        """Presses keys together, "Control", "z", and lets them go."""
        codes = [KEYS.get(name, name) for name in names]
        down = [{"type": "keyDown", "value": code} for code in codes]
        up = [{"type": "keyUp", "value": code} for code in reversed(codes)]
        self.actions({"type": "key", "id": "keys", "actions": down + up})

    def drag(self, start, to, modifier=None):
        """With the left button, from one place of the window to another."""
        move = lambda place: {"type": "pointerMove", "duration": 30, "x": round(place[0]), "y": round(place[1])}
        middle = [(a + b) / 2 for a, b in zip(start, to)]
        mouse = [move(start), {"type": "pointerDown", "button": 0}, move(middle), move(to),
                 {"type": "pointerUp", "button": 0}]
        sources = [{"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"}, "actions": mouse}]
        if modifier:
            held = [{"type": "pause"}] * (len(mouse) - 1)
            keys = [{"type": "keyDown", "value": KEYS[modifier]}, *held, {"type": "keyUp", "value": KEYS[modifier]}]
            sources.append({"type": "key", "id": "keys", "actions": keys})
        self.actions(*sources)

    def wheel(self, place, amount):
        self.actions({"type": "wheel", "id": "wheel", "actions": [
            {"type": "scroll", "x": round(place[0]), "y": round(place[1]), "deltaX": 0, "deltaY": amount}]})

    def click(self, selector):
        element = self.ask("POST", "/element", {"using": "css selector", "value": selector})
        self.ask("POST", f"/element/{next(iter(element.values()))}/click", {})
