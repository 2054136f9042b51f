#include "nodes/evaluate/alignment.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "nodes/types/median.h"
#include "nodes/types/visemes.h"

namespace talkgraph {
namespace {

struct Agreement {
  std::size_t phones = 0;
  std::size_t different = 0;
  std::vector<double> errors;  // ms

  void add(const Agreement& other) {
    phones += other.phones;
    different += other.different;
    errors.insert(errors.end(), other.errors.begin(), other.errors.end());
  }
};

std::vector<Interval> spoken(const PhoneTrack& track) {
  std::vector<Interval> phones;
  std::copy_if(track.phones.begin(), track.phones.end(), std::back_inserter(phones),
               [](const Interval& phone) { return !is_pause(phone.label); });
  return phones;
}

bool is_vowel(const std::string& phone) { return std::string_view("aeiou").find(phone[0]) != std::string_view::npos; }

/// Cost of taking one phone for another; one too many or too few costs 2.
int substitution(const std::string& a, const std::string& b) {
  if (a == b) return 0;
  return is_vowel(a) == is_vowel(b) ? 2 : 3;
}

enum class Step : char { pair, missing, extra };

/// Steps of the least edit distance, the last first.
std::vector<Step> edit_path(const std::vector<Interval>& truth, const std::vector<Interval>& found) {
  const std::size_t n = truth.size(), m = found.size();
  std::vector<Step> steps((n + 1) * (m + 1), Step::extra);
  std::vector<int> row(m + 1), above(m + 1);
  for (std::size_t j = 0; j <= m; ++j) row[j] = 2 * static_cast<int>(j);
  for (std::size_t i = 1; i <= n; ++i) {
    std::swap(row, above);
    row[0] = above[0] + 2;
    steps[i * (m + 1)] = Step::missing;
    for (std::size_t j = 1; j <= m; ++j) {
      const int pair = above[j - 1] + substitution(truth[i - 1].label, found[j - 1].label);
      const int missing = above[j] + 2, extra = row[j - 1] + 2;
      row[j] = std::min({pair, missing, extra});
      steps[i * (m + 1) + j] = row[j] == pair ? Step::pair : row[j] == missing ? Step::missing : Step::extra;
    }
  }
  std::vector<Step> path;
  for (std::size_t i = n, j = m; i + j > 0;) {
    path.push_back(steps[i * (m + 1) + j]);
    i -= path.back() != Step::extra;
    j -= path.back() != Step::missing;
  }
  return path;
}

Agreement compare(const PhoneTrack& true_track, const PhoneTrack& found_track) {
  const auto truth = spoken(true_track), found = spoken(found_track);
  Agreement agreement{truth.size(), 0, {}};
  std::size_t i = truth.size(), j = found.size();
  for (const Step step : edit_path(truth, found)) {
    i -= step != Step::extra;
    j -= step != Step::missing;
    if (step == Step::pair && truth[i].label == found[j].label)
      agreement.errors.push_back(1000 * (found[j].start - truth[i].start));
    else
      ++agreement.different;
  }
  return agreement;
}

std::vector<double> cells(const Agreement& agreement) {
  std::vector<double> errors = agreement.errors, sizes;
  for (const double error : agreement.errors) sizes.push_back(std::abs(error));
  const auto within = [&](double ms) {
    const auto count = std::count_if(sizes.begin(), sizes.end(), [&](double size) { return size <= ms; });
    return sizes.empty() ? NAN : static_cast<double>(count) / static_cast<double>(sizes.size());
  };
  const auto phones = static_cast<double>(agreement.phones);
  return {phones,        agreement.phones ? static_cast<double>(agreement.different) / phones : NAN,
          median(sizes), median(errors),
          within(10),    within(20),
          within(50)};
}

Table empty_table(const char* title, const char* corner) {
  return {
      title, corner, {"phones", "different", "median", "bias", "within 10 ms", "within 20 ms", "within 50 ms"}, {}, {}};
}

}  // namespace

AlignmentTables ScoreAlignment::operator()(const Collected<PhoneTrack>& truth,
                                           const Collected<PhoneTrack>& found) const {
  for (const auto& key : found.keys())
    if (!truth.find(key)) throw std::invalid_argument("phones were found for " + key + ", which has no truth");
  AlignmentTables tables{empty_table("Starts of phones", "sequences"),
                         empty_table("Starts of phones in each sequence", "sequence")};
  Agreement all;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const PhoneTrack* track = found.find(truth.key(i));
    const Agreement one = compare(truth[i], track ? *track : PhoneTrack{});
    all.add(one);
    tables.sequences.rows.push_back(truth.key(i));
    tables.sequences.cells.push_back(cells(one));
  }
  tables.table.rows = {"all"};
  tables.table.cells = {cells(all)};
  return tables;
}

void describe(Description<ScoreAlignment>& d) {
  d.type("evaluate.alignment").summary("how far aligned phones start from where they do");
  d.input("truth", "phones with their true times").input("found", "the same, as they were aligned");
  d.output("table", &AlignmentTables::table, "one row over all phones; times in ms");
  d.output("sequences", &AlignmentTables::sequences, "one row a sequence");
}

}  // namespace talkgraph
