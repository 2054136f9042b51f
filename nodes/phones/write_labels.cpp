#include "nodes/phones/write_labels.h"

#include "graph/output_file.h"
#include "nodes/phones/label_files.h"
#include "nodes/types/item_file.h"

namespace talkgraph {

Artifact WriteLabels::operator()(const PhoneTrack& phones, const WordTrack* words, Context& context) const {
  const auto write = [&](const char* ending, const std::string& text) {
    const Artifact artifact = item_file(context, folder, ending, "phones");
    write_file(context.folder / artifact.path, text);
    return artifact;
  };
  if (format == LabelFormat::htk) return write(".lab", htk_labels(phones.phones));
  if (format == LabelFormat::csv) return write(".csv", csv_labels(phones.phones));
  std::vector<LabelTier> tiers = {{"phones", phones.phones}};
  if (words) tiers.push_back({"words", words->words});
  return write(".TextGrid", text_grid(tiers));
}

void describe(Description<WriteLabels>& d) {
  d.type("phones.write_labels").summary("writes phones as HTK labels, Praat TextGrid or CSV").sink();
  d.input("phones", "with their times")
      .input("words", "a second tier of the TextGrid")
      .output("file", "the label file");
  d.param("format", &WriteLabels::format).doc("htk: .lab, 100 ns; textgrid: Praat; csv: seconds");
  d.param("folder", &WriteLabels::folder).doc("below the run folder");
}

}  // namespace talkgraph
