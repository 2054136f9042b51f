#include "study/store.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/random.h>

#include <array>
#include <ctime>
#include <system_error>
#include <utility>

#include "study/session.h"

namespace talkgraph::study {
namespace {

constexpr auto file_name = "answers.db";
/// A link that got about must not fill the disk.
constexpr std::int64_t most_participants = 100'000;
constexpr int layout = 1;

constexpr std::array tables{
    "CREATE TABLE study (name TEXT PRIMARY KEY, value TEXT NOT NULL) STRICT",
    "CREATE TABLE participant (id INTEGER PRIMARY KEY, token TEXT NOT NULL UNIQUE, seed INTEGER NOT NULL,"
    " agreed INTEGER NOT NULL DEFAULT 0, started INTEGER NOT NULL DEFAULT 0, finished INTEGER NOT NULL DEFAULT 0) "
    "STRICT",
    "CREATE TABLE profile (participant INTEGER NOT NULL REFERENCES participant, question TEXT NOT NULL,"
    " option INTEGER NOT NULL CHECK (option >= 0), UNIQUE (participant, question)) STRICT",
    "CREATE TABLE answer (participant INTEGER NOT NULL REFERENCES participant, test TEXT NOT NULL, clip TEXT NOT NULL,"
    " question TEXT NOT NULL, option INTEGER NOT NULL CHECK (option >= 0), position INTEGER NOT NULL CHECK (position "
    ">= 0),"
    " plays INTEGER NOT NULL CHECK (plays >= 1), seconds REAL NOT NULL CHECK (seconds >= 0), given INTEGER NOT NULL,"
    " UNIQUE (participant, clip, question)) STRICT",
};

template <class Bytes>
Bytes random_bytes() {
  Bytes bytes{};
  if (getentropy(&bytes, sizeof bytes) != 0)
    throw std::system_error(errno, std::generic_category(), "the system's generator of random numbers");
  return bytes;
}

std::string random_token() {
  return fmt::format("{:02x}", fmt::join(random_bytes<std::array<std::uint8_t, 16>>(), ""));
}

std::int64_t now() { return std::time(nullptr); }

/// What answers refer to.
std::string structure(const Study& study) {
  const auto line = [](const Question& q) { return fmt::format(" question {} {}\n", q.id, fmt::join(q.options, "|")); };
  std::string text;
  for (const auto& q : study.profile) text += line(q);
  for (const auto& test : study.tests) {
    text += fmt::format("test {} {} {}\n", test.id, static_cast<int>(test.kind), test.per_category);
    for (const auto& q : test.questions) text += line(q);
    for (const auto& c : test.clips)
      text += fmt::format(" clip {} {} {} {}\n", c.id, c.category(), fmt::join(c.choices, "|"), c.correct);
  }
  return text;
}

std::optional<std::string> noted(const Database& database, const std::string& name) {
  Statement found(database, "SELECT value FROM study WHERE name = ?", name);
  return found.step() ? std::optional(found.text(0)) : std::nullopt;
}

template <class... Value>
std::int64_t number(const Database& database, std::string_view sql, const Value&... values) {
  Statement found(database, sql, values...);
  found.step();
  return found.integer(0);
}

void make(Database& database, const Study& study) {
  Transaction all(database);
  if (number(database, "PRAGMA user_version") != 0) return;
  for (const auto* table : tables) database.run(table);
  const std::string note = "INSERT INTO study VALUES (?, ?)";
  database.run(note, std::string("structure"), structure(study));
  database.run(note, std::string("start"), random_token());
  database.run(note, std::string("report"), random_token());
  database.run(fmt::format("PRAGMA user_version = {}", layout));
  all.commit();
}

Database made(const std::filesystem::path& file, const Study& study) {
  Database database(file, Database::Access::write);
  make(database, study);
  return database;
}

void check(const Database& database, const Study& study, const std::string& file) {
  if (number(database, "PRAGMA user_version") != layout)
    throw std::runtime_error(fmt::format("{}: is no file of answers", file));
  Statement sound(database, "PRAGMA quick_check(1)");
  if (!sound.step() || sound.text(0) != "ok")
    throw DatabaseError(fmt::format("{}: is damaged: {}", file, sound.text(0)));
  if (noted(database, "structure") != structure(study))
    throw std::runtime_error(
        fmt::format("{}: was begun with other tests, questions or clips than study.json has now: put the study back as "
                    "it was, or move the answers elsewhere",
                    file));
}

std::vector<std::string> tests_of(const Study& study, std::uint64_t seed) {
  std::vector<std::string> tests;
  for (const auto& shown : plan(study, seed))
    if (shown.position == 0) tests.push_back(shown.test->id);
  return tests;
}

void read_profile(const Database& database, Participant& participant) {
  Statement row(database, "SELECT question, option FROM profile WHERE participant = ?", participant.id);
  while (row.step()) participant.profile[row.text(0)] = static_cast<int>(row.integer(1));
}

std::vector<Participant> read_participants(const Database& database, const Study& study) {
  std::vector<Participant> all;
  Statement row(database, "SELECT id, started, finished, seed FROM participant WHERE started > 0 ORDER BY id");
  while (row.step()) {
    Participant& one = all.emplace_back();
    one.id = row.integer(0);
    one.started = row.integer(1);
    one.finished = row.integer(2);
    one.tests = tests_of(study, static_cast<std::uint64_t>(row.integer(3)));
    read_profile(database, one);
  }
  return all;
}

std::vector<Answer> read_given(const Database& database) {
  std::vector<Answer> all;
  Statement row(database,
                "SELECT participant, test, clip, question, option, position, plays, seconds, given FROM answer"
                " ORDER BY participant, rowid");
  while (row.step())
    all.push_back({row.integer(0), row.text(1), row.text(2), row.text(3), static_cast<int>(row.integer(4)),
                   static_cast<int>(row.integer(5)), static_cast<int>(row.integer(6)), row.real(7), row.integer(8)});
  return all;
}

}  // namespace

Store::Store(const std::filesystem::path& folder, const Study& study)
    : database_(made(folder / file_name, study)), reader_(folder / file_name, Database::Access::read) {
  check(reader_, study, (folder / file_name).string());
  start_ = noted(reader_, "start").value();
  report_ = noted(reader_, "report").value();
}

void Store::change(const std::function<void()>& make) {
  Change mine{make};
  std::unique_lock lock(mutex_);
  waiting_.push_back(&mine);
  turn_.wait(lock, [&] { return mine.done || !busy_; });
  if (!mine.done) {
    busy_ = true;
    const auto all = std::exchange(waiting_, {});
    lock.unlock();
    make_all(all);
    lock.lock();
    for (auto* one : all) one->done = true;
    busy_ = false;
    turn_.notify_all();
  }
  if (mine.failure) std::rethrow_exception(mine.failure);
}

void Store::make_all(const std::vector<Change*>& changes) {
  try {
    Transaction all(database_);
    for (const auto* one : changes) one->make();
    all.commit();
  } catch (...) {
    for (auto* one : changes) one->failure = std::current_exception();
  }
}

std::optional<std::string> Store::invite(bool agreed) {
  std::optional<std::string> token;
  change([&] {
    if (number(database_, "SELECT count(*) FROM participant") >= most_participants) return;
    token = random_token();
    database_.run("INSERT INTO participant (token, seed, agreed) VALUES (?, ?, ?)", *token,
                  random_bytes<std::int64_t>(), agreed ? now() : 0);
  });
  return token;
}

std::optional<Taker> Store::find(const std::string& token) const {
  const std::lock_guard lock(reading_);
  Statement row(reader_,
                "SELECT id, seed, agreed, started, (SELECT count(DISTINCT clip) FROM answer WHERE participant = id)"
                " FROM participant WHERE token = ?",
                token);
  if (!row.step()) return std::nullopt;
  return Taker{row.integer(0), static_cast<std::uint64_t>(row.integer(1)), row.integer(2) > 0, row.integer(3) > 0,
               static_cast<std::size_t>(row.integer(4))};
}

void Store::agree(const Taker& taker) {
  change([&] { database_.run("UPDATE participant SET agreed = ? WHERE id = ? AND agreed = 0", now(), taker.id); });
}

void Store::keep_profile(const Taker& taker, const std::map<std::string, int>& profile) {
  change([&] {
    database_.run("UPDATE participant SET started = ? WHERE id = ? AND agreed > 0 AND started = 0", now(), taker.id);
    if (sqlite3_changes(database_.get()) == 0) return;
    for (const auto& [question, option] : profile)
      database_.run("INSERT INTO profile VALUES (?, ?, ?)", taker.id, question, option);
  });
}

bool Store::keep(const Taker& taker, std::size_t clips, const std::vector<Answer>& answers, bool last) {
  bool kept = false;
  change([&] {
    const auto before = number(database_, "SELECT count(DISTINCT clip) FROM answer WHERE participant = ?", taker.id);
    kept = static_cast<std::size_t>(before) == clips;
    if (!kept) return;
    for (const auto& a : answers)
      database_.run("INSERT INTO answer VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)", taker.id, a.test, a.clip, a.question,
                    a.option, a.position, a.plays, a.seconds, now());
    if (last) database_.run("UPDATE participant SET finished = ? WHERE id = ?", now(), taker.id);
  });
  return kept;
}

Store::Counts Store::counts() const {
  const std::lock_guard lock(reading_);
  Statement row(
      reader_,
      "SELECT count(*), total(started > 0), total(finished > 0), (SELECT count(*) FROM answer) FROM participant");
  row.step();
  return {row.integer(0), row.integer(1), row.integer(2), row.integer(3)};
}

Answers read_answers(const std::filesystem::path& folder) {
  const auto study = read_study(folder);
  const auto file = folder / file_name;
  if (!std::filesystem::exists(file))
    throw std::runtime_error(
        fmt::format("{}: is not there: nobody has answered yet; `talkgraph study serve` asks", file.string()));
  Database database(file, Database::Access::read);
  database.run("BEGIN");
  check(database, study, file.string());
  return {read_participants(database, study), read_given(database)};
}

}  // namespace talkgraph::study
