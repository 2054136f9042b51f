#include "study/design.h"

namespace talkgraph::study {
namespace {

Json text(const char* description) { return {{"type", "string"}, {"description", description}}; }

Json texts(const char* description) {
  return {{"type", "array"}, {"items", {{"type", "string"}}}, {"description", description}};
}

Json whole(double least, const char* description) {
  return {{"type", "integer"}, {"minimum", least}, {"description", description}};
}

Json object(Json properties) {
  return {{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
}

/// Things by their names; null takes one away from what is extended.
Json named(Json value, const char* description) {
  return {{"type", "object"},
          {"description", description},
          {"propertyNames", {{"pattern", "^[A-Za-z0-9_-]{1,64}$"}}},
          {"additionalProperties", {{"anyOf", {std::move(value), {{"type", "null"}}}}}}};
}

Json question() {
  Json options = texts("to choose from, in order");
  options["minItems"] = 2;
  return object({{"text", text("what is asked")}, {"options", std::move(options)}});
}

Json test() {
  return object({{"kind",
                  {{"enum", {"turing", "perceptual", "intelligibility"}},
                   {"description",
                    "turing: lower halves of faces; perceptual: whole faces, with recorded and static "
                    "eyes; intelligibility: silent clips and sentences to choose from"}}},
                 {"title", text("heading")},
                 {"instructions", texts("paragraphs")},
                 {"questions", named(question(), "asked about each clip")},
                 {"clips", whole(1, "that a person sees, equally many of each category")},
                 {"pool", whole(1, "that they are drawn from, at most; if not given, everybody sees the same")},
                 {"eyes",
                  {{"type", "array"},
                   {"items", {{"enum", {"recorded", "static"}}}},
                   {"uniqueItems", true},
                   {"description", "of a perceptual test: a category for each; none: those of the recording"}}},
                 {"choices",
                  {{"type", "integer"},
                   {"minimum", 2},
                   {"maximum", 20},
                   {"default", 4},
                   {"description", "of an intelligibility test: sentences to choose from"}}}});
}

Json ports() {
  const auto port = [](const char* description) { return text(description); };
  Json out = object({{"face", port("AppearanceModel")},
                     {"recorded", port("normalised visual parameters of the recordings held out")},
                     {"synthesised", port("those imitated")},
                     {"mean", port("what normalising took off the recorded ones")},
                     {"mouths", port("Mouths of the recordings trained on")},
                     {"audio", port("sound of the recordings held out")},
                     {"recordings", port("the recordings held out")},
                     {"sentences", port("recordings whose transcripts serve as false choices, too")}});
  out["description"] =
      "ports of the runs' graphs, \"NODE.PORT\": an output, or an input, which means what is wired to it";
  return out;
}

}  // namespace

Json design_schema() {
  Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"},
                 {"title", "talkgraph study"},
                 {"description", "What a study shows and asks; docs/study.md explains"}};
  schema.update(
      object({{"$schema", text("this schema")},
              {"description", text("what it is to find out")},
              {"extends", text("a study that this one is laid over: members are merged, null takes one away")},
              {"title", text("heading of the page")},
              {"seed", whole(0, "of what is chosen")},
              {"speakers", texts("names of the runs, in order; empty: as their reports are called")},
              {"draw", text("graph that draws the clips")},
              {"take", ports()},
              {"consent", texts("paragraphs of the first page")},
              {"profile", named(question(), "asked of a person; the last option of each is not to say")},
              {"split_by", text("question of the profile by which answers are compared")},
              {"tests", named(test(), "in any order: each person has one of their own")},
              {"thanks", texts("paragraphs of the last page")}}));
  schema["anyOf"] = {{{"required", {"extends"}}},
                     {{"required", {"title", "consent", "thanks", "draw", "take", "tests"}}}};
  return schema;
}

}  // namespace talkgraph::study
