#include "study/choose.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "graph/random.h"

namespace talkgraph::study {
namespace {

constexpr double most_longer = 1.25;

/// What makes sentences differ: letters and digits.
std::string plain(const std::string& sentence) {
  std::string out;
  for (const unsigned char c : sentence)
    if (c >= 0x80 || std::isalnum(c)) out += static_cast<char>(std::tolower(c));
  return out;
}

std::ptrdiff_t characters(const std::string& utf8) {
  return std::count_if(utf8.begin(), utf8.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; });
}

std::size_t index(std::size_t n, Random& random) { return static_cast<std::size_t>(random.below(n)); }

/// Names that tell nothing.
class Names {
 public:
  std::string next(Random& random) {
    constexpr std::string_view letters = "abcdefghijkmnpqrstuvwxyz23456789";
    std::string name;
    do {
      name.clear();
      for (int i = 0; i < 12; ++i) name += letters[index(letters.size(), random)];
    } while (!taken_.insert(name).second);
    return name;
  }

 private:
  std::set<std::string> taken_;
};

/// The sentences that a speaker's clips can be told apart from.
class Sentences {
 public:
  Sentences(const Speaker& speaker, int choices) : choices_(static_cast<std::size_t>(choices)) {
    auto all = speaker.sentences;
    for (const auto& s : speaker.sequences) all.push_back(s.sentence), held_out_.insert(plain(s.sentence));
    groups_ = by_length(all);
    for (std::size_t g = 0; g < groups_.size(); ++g)
      for (const auto& sentence : groups_[g]) group_of_[plain(sentence)] = g;
  }

  std::size_t count() const { return group_of_.size(); }
  bool suffice_for(const std::string& sentence) const {
    const auto found = group_of_.find(plain(sentence));
    return found != group_of_.end() && groups_[found->second].size() >= choices_;
  }
  /// False choices are sentences of other sequences held out, as far as there are: a person who heard some of these in
  /// another test would know the right one from among sentences that nobody hears.
  void offer(Clip& clip, const std::string& sentence, Random& random) const {
    auto others = groups_[group_of_.at(plain(sentence))];
    std::erase_if(others, [&](const auto& other) { return plain(other) == plain(sentence); });
    random.shuffle(others);
    std::stable_partition(others.begin(), others.end(), [&](const auto& o) { return held_out_.contains(plain(o)); });
    others.resize(choices_ - 1);
    clip.correct = static_cast<int>(index(choices_, random));
    others.insert(others.begin() + clip.correct, sentence);
    clip.choices = std::move(others);
  }

 private:
  std::size_t choices_;
  std::vector<std::vector<std::string>> groups_;
  std::map<std::string, std::size_t> group_of_;
  std::set<std::string> held_out_;
};

/// One category of a test, of one speaker.
struct Category {
  bool synthetic = false;
  std::string eyes;
  std::vector<std::size_t> taken;  ///< sequences
};

/// A test as far as one speaker is in it.
struct Part {
  const TestDesign* test = nullptr;
  std::vector<std::size_t> usable;  ///< sequences, in random order
  std::vector<Category> categories;
  std::size_t shown = 0, pool = 0;  ///< of a category

  bool holds(std::size_t sequence) const {
    return std::any_of(categories.begin(), categories.end(), [&](const auto& c) { return has(c, sequence); });
  }
  static bool has(const Category& c, std::size_t sequence) {
    return std::find(c.taken.begin(), c.taken.end(), sequence) != c.taken.end();
  }
};

/// Gives out the sequences of one speaker.
class Dealer {
 public:
  explicit Dealer(std::size_t sequences) : uses_(sequences, 0) {}

  void deal(Part& part) {
    for (std::size_t k = 0; k < part.shown; ++k)
      for (auto& category : part.categories) take(category, best(part, category));
  }

  /// Gives each category one more, if as many sequences are left over.
  bool widen(Part& part) {
    if (part.categories.front().taken.size() >= part.pool) return false;
    std::vector<std::size_t> free;
    for (const auto s : part.usable)
      if (uses_[s] == 0) free.push_back(s);
    if (free.size() < part.categories.size()) return false;
    for (std::size_t c = 0; c < part.categories.size(); ++c) take(part.categories[c], free[c]);
    return true;
  }

  std::ptrdiff_t used_again() const {
    return std::count_if(uses_.begin(), uses_.end(), [](int uses) { return uses > 1; });
  }

 private:
  /// Preferably one that the test has not, then one that others have least; there is one.
  std::size_t best(const Part& part, const Category& category) const {
    std::vector<std::size_t> left;
    for (const auto s : part.usable)
      if (!Part::has(category, s)) left.push_back(s);
    return *std::min_element(left.begin(), left.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(part.holds(a), uses_[a]) < std::pair(part.holds(b), uses_[b]);
    });
  }
  void take(Category& category, std::size_t sequence) {
    category.taken.push_back(sequence);
    ++uses_[sequence];
  }

  std::vector<int> uses_;
};

class Chooser {
 public:
  Chooser(const Design& design, const std::vector<Speaker>& speakers, Diagnostics& diagnostics)
      : design_(design), speakers_(speakers), diagnostics_(diagnostics), random_(design.seed, "study", "") {}

  std::optional<Study> choose(std::vector<std::string>& notes) {
    Study study{design_.title, design_.consent, design_.thanks, design_.profile, design_.split_by, {}};
    for (const auto& test : design_.tests) {
      if (!check_even(test)) continue;
      study.tests.push_back(
          {test.id, test.kind, test.title, test.instructions, test.questions, static_cast<int>(shown(test)), {}});
    }
    for (const auto& speaker : speakers_) add(speaker, study, notes);
    if (!diagnostics_.ok()) return {};
    for (auto& test : study.tests)
      std::sort(test.clips.begin(), test.clips.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
    return study;
  }

 private:
  static std::size_t of_speaker(const TestDesign& test) { return 2 * std::max<std::size_t>(1, test.eyes.size()); }
  std::size_t categories(const TestDesign& test) const { return speakers_.size() * of_speaker(test); }
  std::size_t shown(const TestDesign& test) const { return static_cast<std::size_t>(test.clips) / categories(test); }

  bool check_even(const TestDesign& test) {
    const auto clips = static_cast<std::size_t>(test.clips), n = categories(test), less = clips / n * n;
    if (clips == less) return true;
    diagnostics_.error(
        design_.at({"tests", test.id, "clips"}),
        fmt::format("test \"{}\": {} clips cannot be shared evenly among {} categories (runs: {}, real and "
                    "synthetic{}): take {}{}",
                    test.id, clips, n, speakers_.size(), test.eyes.size() > 1 ? ", both kinds of eyes" : "",
                    less > 0 ? fmt::format("{} or ", less) : "", less + n));
    return false;
  }

  void add(const Speaker& speaker, Study& study, std::vector<std::string>& notes) {
    std::vector<Part> parts;
    for (const auto& test : design_.tests) parts.push_back(part_of(test, speaker));
    if (!diagnostics_.ok()) return;
    Dealer dealer(speaker.sequences.size());
    // Those that can take the fewest first.
    std::vector<Part*> order;
    for (auto& part : parts) order.push_back(&part);
    std::stable_sort(order.begin(), order.end(),
                     [](const Part* a, const Part* b) { return a->usable.size() < b->usable.size(); });
    for (auto* part : order) dealer.deal(*part);
    for (bool more = true; more;) {
      more = false;
      for (auto* part : order) more |= dealer.widen(*part);
    }
    if (const auto again = dealer.used_again())
      notes.push_back(
          fmt::format("{}: {} sequences do not suffice to show each only once: {} are in several clips, and "
                      "who heard one may know it in a silent clip",
                      speaker.title, speaker.sequences.size(), again));
    for (std::size_t t = 0; t < parts.size(); ++t) name_clips(parts[t], speaker, study.tests[t]);
  }

  Part part_of(const TestDesign& test, const Speaker& speaker) {
    Part part;
    part.test = &test;
    part.shown = shown(test);
    part.pool = static_cast<std::size_t>(test.pool) / categories(test);
    for (const bool synthetic : {false, true}) {
      if (test.eyes.empty()) part.categories.push_back({synthetic, "", {}});
      for (const auto& eyes : test.eyes) part.categories.push_back({synthetic, eyes, {}});
    }
    const Sentences sentences(speaker, test.choices);
    for (std::size_t s = 0; s < speaker.sequences.size(); ++s)
      if (test.kind != TestKind::intelligibility || sentences.suffice_for(speaker.sequences[s].sentence))
        part.usable.push_back(s);
    random_.shuffle(part.usable);
    if (part.usable.size() < part.shown) complain_few(part, speaker, sentences);
    return part;
  }

  void complain_few(const Part& part, const Speaker& speaker, const Sentences& sentences) {
    const auto& test = *part.test;
    const auto choices = static_cast<std::size_t>(test.choices);
    if (test.kind == TestKind::intelligibility && sentences.count() < choices)
      return diagnostics_.error(
          design_.at({"tests", test.id, "choices"}),
          fmt::format("test \"{}\": {} sentences to choose from, but all transcripts of {} make {} different ones",
                      test.id, choices, speaker.title, sentences.count()));
    const std::string which = test.kind == TestKind::intelligibility
                                  ? fmt::format(" with {} other sentences of about the same length", choices - 1)
                                  : "";
    diagnostics_.error(
        design_.at({"tests", test.id, "clips"}),
        fmt::format(
            "test \"{}\": {} sequences are needed for each category, but {} has {} held out{}: at most {} clips "
            "can be shown",
            test.id, part.shown, speaker.title, part.usable.size(), which, part.usable.size() * categories(test)));
  }

  void name_clips(const Part& part, const Speaker& speaker, Test& test) {
    const Sentences sentences(speaker, part.test->choices);
    for (const auto& category : part.categories)
      for (const auto s : category.taken) {
        const auto& sequence = speaker.sequences[s];
        auto& clip = test.clips.emplace_back();
        clip.id = names_.next(random_);
        clip.speaker = speaker.title;
        clip.sequence = sequence.id;
        clip.synthetic = category.synthetic;
        clip.eyes = category.eyes;
        clip.seconds = sequence.seconds;
        if (test.kind == TestKind::intelligibility) sentences.offer(clip, sequence.sentence, random_);
      }
  }

  const Design& design_;
  const std::vector<Speaker>& speakers_;
  Diagnostics& diagnostics_;
  Random random_;
  Names names_;
};

}  // namespace

std::vector<std::vector<std::string>> by_length(const std::vector<std::string>& sentences) {
  std::map<std::string, std::string> different;
  for (const auto& sentence : sentences)
    if (!plain(sentence).empty()) different.emplace(plain(sentence), sentence);
  std::vector<std::string> sorted;
  for (const auto& [key, sentence] : different) sorted.push_back(sentence);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return characters(a) < characters(b); });
  std::vector<std::vector<std::string>> groups;
  for (auto& sentence : sorted) {
    const bool fits = !groups.empty() && static_cast<double>(characters(sentence)) <=
                                             most_longer * static_cast<double>(characters(groups.back().front()));
    if (!fits) groups.emplace_back();
    groups.back().push_back(std::move(sentence));
  }
  return groups;
}

std::optional<Study> choose(const Design& design, const std::vector<Speaker>& speakers, std::vector<std::string>& notes,
                            Diagnostics& diagnostics) {
  return Chooser(design, speakers, diagnostics).choose(notes);
}

}  // namespace talkgraph::study
