#pragma once

#include "graph/description.h"
#include "nodes/types/phones.h"
#include "nodes/types/report.h"

namespace talkgraph {

enum class LabelFormat { htk, textgrid, csv };
template <>
inline constexpr EnumNames<LabelFormat, 3> enum_names<LabelFormat>{
    {{LabelFormat::htk, "htk"}, {LabelFormat::textgrid, "textgrid"}, {LabelFormat::csv, "csv"}}};

/// Writes the phones of each utterance to FOLDER/ITEM.lab, .TextGrid or .csv below
/// the run folder; a TextGrid holds the words, where given, as a second tier.
/// A corpus manifest reads the files back. Errors: the file cannot be written; intervals
/// that are not in order, or whose times are not finite; for HTK, a label that is
/// empty or has a space in it.
struct WriteLabels {
  LabelFormat format = LabelFormat::textgrid;
  std::string folder = "labels";
  Artifact operator()(const PhoneTrack& phones, const WordTrack* words, Context& context) const;
};
void describe(Description<WriteLabels>& d);

}  // namespace talkgraph
