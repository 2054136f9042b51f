#include "nodes/write/labels.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "graph/output_file.h"
#include "nodes/phones/label_files.h"
#include "nodes/types/item_file.h"

namespace talkgraph {

namespace {

void check(const std::vector<Interval>& intervals, LabelFormat format) {
  double last = 0;
  for (const auto& i : intervals) {
    // Negated, so that NaN is refused as well.
    if (!(i.start >= last - 1e-6 && i.end >= i.start && std::isfinite(i.end)))
      throw std::invalid_argument(fmt::format("the interval \"{}\" from {} s to {} s is not in order after {} s",
                                              i.label, i.start, i.end, last));
    if (format == LabelFormat::htk && (i.label.empty() || i.label.find_first_of(" \t\r\n") != std::string::npos))
      throw std::invalid_argument(
          fmt::format("an HTK file has one word a label, not \"{}\" (at {} s): write a textgrid", i.label, i.start));
    last = i.end;
  }
}

}  // namespace

Artifact WriteLabels::operator()(const PhoneTrack& phones, const WordTrack* words, Context& context) const {
  check(phones.phones, format);
  if (words && format == LabelFormat::textgrid) check(words->words, format);
  const auto write = [&](const char* ending, const std::string& text) {
    const Artifact artifact = item_file(context, folder, ending, "phones");
    write_file(context.file(artifact.path), text);
    return artifact;
  };
  if (format == LabelFormat::htk) return write(".lab", htk_labels(phones.phones));
  if (format == LabelFormat::csv) return write(".csv", csv_labels(phones.phones));
  std::vector<LabelTier> tiers = {{"phones", phones.phones}};
  if (words) tiers.push_back({"words", words->words});
  return write(".TextGrid", text_grid(tiers));
}

void describe(Description<WriteLabels>& d) {
  d.type("write.labels").summary("writes phones as HTK labels, Praat TextGrid or CSV").sink();
  d.input("phones", "with their times")
      .input("words", "a second tier of the TextGrid")
      .output("file", "the label file");
  d.param("format", &WriteLabels::format).doc("htk: .lab, 100 ns; textgrid: Praat; csv: seconds");
  d.param("folder", &WriteLabels::folder).doc("below the run folder");
}

}  // namespace talkgraph
