#pragma once

#include "graph/description.h"
#include "nodes/types/phones.h"
#include "nodes/types/report.h"

namespace talkgraph {

enum class VisemeFormat { tsv, json };
template <>
inline constexpr EnumNames<VisemeFormat, 2> enum_names<VisemeFormat>{
    {{VisemeFormat::tsv, "tsv"}, {VisemeFormat::json, "json"}}};

/// A viseme track in the formats of Rhubarb Lip Sync. TSV: a line "start<tab>shape" each
/// time the mouth changes, seconds with two decimals, closed by the end with
/// "X". JSON: {"metadata": {"soundFile", "duration"}, "mouthCues": [{"start", "end", "value"}]}.
std::string viseme_text(const PhoneTrack& phones, VisemeFormat format, const std::string& sound_file);

/// Writes the mouth shapes of each utterance to FOLDER/ITEM.tsv or .json below the
/// run folder. Errors: the file cannot be written, a label is no phone.
struct WriteVisemes {
  VisemeFormat format = VisemeFormat::tsv;
  std::string folder = "visemes";
  Artifact operator()(const PhoneTrack& phones, Context& context) const;
};
void describe(Description<WriteVisemes>& d);

}  // namespace talkgraph
