#include "nodes/write/visemes.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "graph/output_file.h"
#include "nodes/phones/mouth_shapes.h"
#include "nodes/types/item_file.h"

namespace talkgraph {
namespace {

double duration(const PhoneTrack& phones) { return phones.phones.empty() ? 0 : phones.phones.back().end; }

std::string tsv(const std::vector<Interval>& shapes, double end) {
  std::string text;
  for (const auto& shape : shapes) text += fmt::format("{:.2f}\t{}\n", shape.start, shape.label);
  return text + fmt::format("{:.2f}\tX\n", end);
}

std::string json(const std::vector<Interval>& shapes, double end, const std::string& sound_file) {
  std::string cues;
  for (const auto& shape : shapes)
    cues += fmt::format("{}    {{ \"start\": {:.2f}, \"end\": {:.2f}, \"value\": \"{}\" }}", cues.empty() ? "" : ",\n",
                        shape.start, shape.end, shape.label);
  return fmt::format(
      "{{\n  \"metadata\": {{\n    \"soundFile\": {},\n    \"duration\": {:.2f}\n  }},\n  \"mouthCues\": [\n{}\n  "
      "]\n}}\n",
      nlohmann::json(sound_file).dump(), end, cues);
}

}  // namespace

std::string viseme_text(const PhoneTrack& phones, VisemeFormat format, const std::string& sound_file) {
  const auto shapes = mouth_shapes(phones);
  return format == VisemeFormat::tsv ? tsv(shapes, duration(phones)) : json(shapes, duration(phones), sound_file);
}

Artifact WriteVisemes::operator()(const PhoneTrack& phones, Context& context) const {
  const Artifact artifact = item_file(context, folder, format == VisemeFormat::tsv ? ".tsv" : ".json", "visemes");
  write_file(context.file(artifact.path), viseme_text(phones, format, context.item));
  return artifact;
}

void describe(Description<WriteVisemes>& d) {
  d.type("write.visemes").summary("writes mouth shapes in the formats of Rhubarb Lip Sync").sink();
  d.input("phones", "with their times").output("file", "the viseme file");
  d.param("format", &WriteVisemes::format).doc("as rhubarb writes them with -f tsv or -f json");
  d.param("folder", &WriteVisemes::folder).doc("below the run folder");
}

}  // namespace talkgraph
