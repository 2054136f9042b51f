#include "nodes/evaluate/alignment.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "nodes/evaluate/edit_path.h"
#include "nodes/types/median.h"
#include "nodes/types/visemes.h"

namespace talkgraph {
namespace {

struct Agreement {
  std::size_t phones = 0;
  std::size_t different = 0;
  double time = 0;             // of the phones, seconds
  double right = 0;            // of it under the same phone, seconds
  std::vector<double> errors;  // ms

  void add(const Agreement& other) {
    phones += other.phones;
    different += other.different;
    time += other.time;
    right += other.right;
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

/// Seconds in which both have the same phone; each in order, without overlaps.
double shared_time(const std::vector<Interval>& truth, const std::vector<Interval>& found) {
  double time = 0;
  for (std::size_t i = 0, j = 0; i < truth.size() && j < found.size();) {
    const double overlap = std::min(truth[i].end, found[j].end) - std::max(truth[i].start, found[j].start);
    if (overlap > 0 && truth[i].label == found[j].label) time += overlap;
    truth[i].end < found[j].end ? ++i : ++j;
  }
  return time;
}

Agreement compare(const PhoneTrack& true_track, const PhoneTrack& found_track) {
  const auto truth = spoken(true_track), found = spoken(found_track);
  Agreement agreement{.phones = truth.size(), .right = shared_time(truth, found), .errors = {}};
  for (const Interval& phone : truth) agreement.time += phone.end - phone.start;
  std::size_t i = truth.size(), j = found.size();
  const auto pair = [&](std::size_t a, std::size_t b) { return substitution(truth[a].label, found[b].label); };
  for (const Edit step : edit_path(truth.size(), found.size(), 2, pair)) {
    i -= step != Edit::extra;
    j -= step != Edit::missing;
    if (step == Edit::pair && truth[i].label == found[j].label)
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
  return {phones,
          agreement.phones ? static_cast<double>(agreement.different) / phones : NAN,
          agreement.time > 0 ? agreement.right / agreement.time : NAN,
          median(sizes),
          median(errors),
          within(10),
          within(20),
          within(50)};
}

Table empty_table(const char* title, const char* corner) {
  return {title,
          corner,
          {"phones", "different", "right time", "median", "bias", "within 10 ms", "within 20 ms", "within 50 ms"},
          {},
          {}};
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
  d.type("evaluate.alignment").version(2).summary("how far phones that were found are right, and start where they do");
  d.input("truth", "phones with their true times")
      .input("found", "the same, as they were aligned, recognised or decoded");
  d.output("table", &AlignmentTables::table, "one row over all phones; times in ms");
  d.output("sequences", &AlignmentTables::sequences, "one row a sequence");
}

}  // namespace talkgraph
