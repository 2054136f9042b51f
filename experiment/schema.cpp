#include "experiment/experiment.h"

namespace talkgraph {
namespace {

Json text(const char* description) { return {{"type", "string"}, {"description", description}}; }

Json names(const char* description) {
  return {{"type", "array"}, {"items", {{"type", "string"}}}, {"description", description}};
}

Json object(Json properties, const std::vector<std::string>& required = {}) {
  Json out = {{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
  if (!required.empty()) out["required"] = required;
  return out;
}

Json object_of(Json value) { return {{"type", "object"}, {"additionalProperties", std::move(value)}}; }

Json refer(const char* definition) { return {{"$ref", std::string("#/definitions/") + definition}}; }

Json whole(double least) { return {{"type", "integer"}, {"minimum", least}}; }

}  // namespace

Json experiment_schema() {
  const Json list = {{"type", "array"}, {"items", true}, {"minItems", 1}, {"uniqueItems", true}};
  const Json path =
      text("what is set, if not the factor's name: nodes.mel.params.filters, or a parameter of the graph");
  const Json number = {{"type", "number"}};
  Json stepped = object(
      {{"path", path}, {"from", number}, {"to", number}, {"step", {{"type", "number"}, {"exclusiveMinimum", 0}}}},
      {"from", "to", "step"});
  Json counted = object({{"path", path},
                         {"from", number},
                         {"to", number},
                         {"count", whole(1)},
                         {"scale", {{"enum", {"linear", "log"}}, {"default", "linear"}}}},
                        {"from", "to", "count"});
  Json definitions = {
      {"changes", {{"type", {"object", "null"}}, {"description", "paths and values; null where it is taken away"}}},
      {"values",
       {{"anyOf",
         {list, object({{"path", path}, {"values", list}}, {"values"}), std::move(stepped), std::move(counted)}}}},
      {"factor",
       {{"anyOf",
         {refer("values"),
          {{"description", "named levels, each a set of changes"},
           {"allOf", {object({{"levels", object_of(refer("changes"))}}, {"levels"})}}},
          {{"description", "lists that move together: the first values, then the second ones"},
           {"allOf", {object({{"together", object_of(refer("values"))}}, {"together"})}}}}}}}};
  Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"},
                 {"title", "talkgraph experiment"},
                 {"description", "A graph run with many settings; docs/experiments.md explains"}};
  schema.update(object(
      {{"$schema", text("this schema")},
       {"description", text("what it is to find out")},
       {"extends", text("an experiment that this one is laid over: members are merged, null takes one away")},
       {"graph", text("the graph file that is run")},
       {"set", {{"description", "changes that all runs have"}, {"allOf", {refer("changes")}}}},
       {"vary", object_of(refer("factor"))},
       {"repeats", {{"description", "runs of each setting, with seeds 1, 2, ..."}, {"allOf", {whole(1)}}}},
       {"seeds",
        {{"description", "seeds of the repeats"}, {"type", "array"}, {"items", whole(0)}, {"uniqueItems", true}}},
       {"tabulate", names("outputs of the graph that are tables or scores")},
       {"plot", names("measures to plot; all if not given")},
       {"show", names("outputs with clips or pictures that the page shows beside each other")},
       {"sections",
        {{"description", "of a series: experiments run one after the other, told of on one page"},
         {"type", "array"},
         {"minItems", 1},
         {"items", object({{"title", text("heading of the section")},
                           {"text", text("what it shows; paragraphs stand apart by empty lines")},
                           {"table",
                            {{"description", "a table of texts"},
                             {"allOf",
                              {object({{"columns", names("their headings")},
                                       {"rows", object_of({{"type", "array"}, {"items", {{"type", "string"}}}})}},
                                      {"columns", "rows"})}}}},
                           {"experiments", names("files of the experiments whose results it has")}})}}}},
      {}));
  schema["anyOf"] = {{{"required", {"graph", "tabulate"}}},
                     {{"required", {"graph", "show"}}},
                     {{"required", {"extends"}}},
                     {{"required", {"sections"}}}};
  schema["definitions"] = std::move(definitions);
  return schema;
}

}  // namespace talkgraph
