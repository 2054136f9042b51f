#include "study/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <tuple>

#include "nodes/statistics/intervals.h"
#include "nodes/statistics/signed_rank.h"

namespace talkgraph::study {
namespace {

using Kind = Comparison::Kind;
using Which = std::function<bool(const Score&)>;

/// Clips that are told apart by nothing but being real or synthetic.
struct Condition {
  std::string name, speaker, eyes;
  bool all = false;

  bool has(const Clip& clip) const { return all || (clip.speaker == speaker && clip.eyes == eyes); }
};

struct Group {
  std::string name;
  std::set<std::int64_t> people;
};

template <class T>
void add_once(std::vector<T>& list, const T& element) {
  if (std::find(list.begin(), list.end(), element) == list.end()) list.push_back(element);
}

/// In the order of the clips, and all of them if they are several.
std::vector<Condition> conditions_of(const Test& test) {
  std::vector<Condition> conditions;
  for (const auto& clip : test.clips) {
    const auto has = [&](const Condition& c) { return c.has(clip); };
    if (std::any_of(conditions.begin(), conditions.end(), has)) continue;
    const std::string eyes = clip.eyes.empty() ? "" : ", " + clip.eyes + " eyes";
    conditions.push_back({clip.speaker + eyes, clip.speaker, clip.eyes});
  }
  if (conditions.size() > 1) conditions.push_back({"all clips", "", "", true});
  return conditions;
}

std::vector<std::string> speakers_of(const Test& test) {
  std::vector<std::string> speakers;
  for (const auto& clip : test.clips) add_once(speakers, clip.speaker);
  if (speakers.size() > 1) speakers.emplace_back();  // all of them
  return speakers;
}

std::vector<Group> groups_of(const Study& study, const std::vector<Participant>& people) {
  const Question* question = split_question(study);
  if (!question) return {};
  std::vector<Group> groups;
  for (std::size_t option = 0; option + 1 < question->options.size(); ++option) {
    groups.push_back({fmt::format("{}: {}", plain_name(question->id), question->options[option]), {}});
    for (const auto& person : people)
      if (profile_option(*question, person) == static_cast<int>(option)) groups.back().people.insert(person.id);
  }
  return groups;
}

Means means_where(const Measure& measure, const Which& which) {
  std::vector<Score> scores;
  std::copy_if(measure.scores.begin(), measure.scores.end(), std::back_inserter(scores), which);
  return means_of(scores);
}

/// Differences of means that are equal are equal numbers, though quotients are rounded: 1 − 2/3 is 2/3 − 1/3.
double difference_of(double a, double b) {
  constexpr double unit = 1e-9;
  return unit * std::round((a - b) / unit);
}

void test(Comparison& c) {
  if (c.first.size() >= 2 && c.second.size() >= 2)
    c.test = rank_sum(values_of(c.first), values_of(c.second));
  else
    c.test = {.p = NAN, .effect = NAN};
  std::vector<double> differences;
  for (const auto& [person, mean] : c.first)
    if (const auto other = c.second.find(person); other != c.second.end())
      differences.push_back(difference_of(mean, other->second));
  if (differences.size() >= 2) c.p_paired = signed_rank(differences).p;
}

/// Adds comparisons of one measure.
class Comparer {
 public:
  Comparer(Findings& findings, std::size_t measure)
      : findings_(findings), number_(measure), measure_(findings.measures[measure]), test_(*measure_.test) {}

  void compare_clips() {
    for (const auto& condition : conditions_of(test_))
      add(Kind::clips, condition.name, {"real", of(condition, false)}, {"synthetic", of(condition, true)});
  }

  void compare_eyes() {
    for (const char* eyes : {"recorded", "static"})
      if (std::none_of(test_.clips.begin(), test_.clips.end(), [&](const Clip& c) { return c.eyes == eyes; })) return;
    for (const auto& speaker : speakers_of(test_))
      for (const bool synthetic : {false, true}) {
        const auto with = [&](const std::string& eyes) -> Which {
          return [=](const Score& s) {
            return s.clip->eyes == eyes && s.clip->synthetic == synthetic &&
                   (speaker.empty() || s.clip->speaker == speaker);
          };
        };
        add(Kind::eyes, (speaker.empty() ? "all speakers" : speaker) + (synthetic ? ", synthetic" : ", real"),
            {"recorded eyes", with("recorded")}, {"static eyes", with("static")});
      }
  }

  void compare_groups(const std::vector<Group>& groups) {
    for (const auto& group : groups)
      for (const auto& condition : conditions_of(test_))
        add(Kind::clips_in_groups, condition.name + ", " + group.name, {"real", of(condition, false, &group)},
            {"synthetic", of(condition, true, &group)});
    for (std::size_t i = 0; i < groups.size(); ++i)
      for (std::size_t j = i + 1; j < groups.size(); ++j)
        for (const auto& condition : conditions_of(test_))
          for (const bool synthetic : {false, true})
            add(Kind::groups, condition.name + (synthetic ? ", synthetic" : ", real"),
                {groups[i].name, of(condition, synthetic, &groups[i])},
                {groups[j].name, of(condition, synthetic, &groups[j])});
  }

  void compare_plays() {
    for (const bool synthetic : {false, true})
      add(Kind::plays, synthetic ? "synthetic clips" : "real clips",
          {"seen once", [=](const Score& s) { return s.clip->synthetic == synthetic && s.plays <= 1; }},
          {"replayed", [=](const Score& s) { return s.clip->synthetic == synthetic && s.plays > 1; }});
  }

 private:
  struct Side {
    std::string name;
    Which which;
  };

  static Which of(const Condition& condition, bool synthetic, const Group* group = nullptr) {
    return [&condition, synthetic, group](const Score& s) {
      return condition.has(*s.clip) && s.clip->synthetic == synthetic &&
             (!group || group->people.contains(s.participant));
    };
  }

  void add(Kind kind, const std::string& name, const Side& first, const Side& second) {
    Comparison c;
    c.kind = kind, c.measure = number_, c.of = name;
    c.first_name = first.name, c.second_name = second.name;
    c.first = means_where(measure_, first.which);
    c.second = means_where(measure_, second.which);
    test(c);
    findings_.comparisons.push_back(std::move(c));
  }

  Findings& findings_;
  const std::size_t number_;
  const Measure& measure_;
  const Test& test_;
};

void correct(Findings& findings) {
  std::map<std::pair<const Test*, Kind>, std::vector<Comparison*>> families;
  for (auto& c : findings.comparisons) families[{findings.measures[c.measure].test, c.kind}].push_back(&c);
  const auto correct_each = [&](const std::vector<Comparison*>& family, const auto& from, const auto& to) {
    std::vector<double> p;
    for (const auto* c : family) p.push_back(from(*c));
    p = corrected(p, findings.options.correction);
    for (std::size_t i = 0; i < p.size(); ++i) to(*family[i]) = p[i];
  };
  for (const auto& [key, family] : families) {
    correct_each(
        family, [](const Comparison& c) { return c.test.p; }, [](Comparison& c) -> double& { return c.p_corrected; });
    correct_each(
        family, [](const Comparison& c) { return c.p_paired; },
        [](Comparison& c) -> double& { return c.p_paired_corrected; });
  }
}

Answers counted(const Answers& answers, bool finished_only) {
  std::set<std::int64_t> gave_one, left_out;
  for (const auto& answer : answers.answers) gave_one.insert(answer.participant);
  Answers counted;
  for (const auto& person : answers.participants)
    if (finished_only && person.finished == 0)
      left_out.insert(person.id);
    else if (gave_one.contains(person.id))
      counted.participants.push_back(person);
  for (const auto& answer : answers.answers)
    if (!left_out.contains(answer.participant)) counted.answers.push_back(answer);
  return counted;
}

}  // namespace

double Comparison::difference() const { return mean_of(values_of(first)) - mean_of(values_of(second)); }

const Question* split_question(const Study& study) {
  const auto it = std::find_if(study.profile.begin(), study.profile.end(),
                               [&](const Question& q) { return q.id == study.split_by; });
  return it == study.profile.end() ? nullptr : &*it;
}

Findings find(const Study& study, const Answers& answers, const FindingOptions& options) {
  Answers of = counted(answers, options.finished_only);
  Findings findings;
  findings.study = &study, findings.options = options;
  findings.took_part = answers.participants.size();
  findings.finished = static_cast<std::size_t>(std::count_if(answers.participants.begin(), answers.participants.end(),
                                                             [](const Participant& p) { return p.finished != 0; }));
  findings.measures = measures_of(study, of);
  findings.people = std::move(of.participants);
  const auto groups = groups_of(study, findings.people);
  for (std::size_t m = 0; m < findings.measures.size(); ++m) {
    Comparer comparer(findings, m);
    comparer.compare_clips();
    comparer.compare_eyes();
    if (findings.measures[m].test->kind == TestKind::intelligibility) comparer.compare_groups(groups);
    comparer.compare_plays();
  }
  correct(findings);
  return findings;
}

std::vector<std::vector<Comparison>> tabled(const std::vector<Comparison>& comparisons) {
  std::vector<std::vector<Comparison>> tables;
  for (const auto& c : comparisons) {
    const auto goes_with = [&](const std::vector<Comparison>& table) {
      const Comparison& other = table.front();
      return std::tie(c.kind, c.first_name, c.second_name) == std::tie(other.kind, other.first_name, other.second_name);
    };
    const auto it = std::find_if(tables.begin(), tables.end(), goes_with);
    (it == tables.end() ? tables.emplace_back() : *it).push_back(c);
  }
  return tables;
}

}  // namespace talkgraph::study
