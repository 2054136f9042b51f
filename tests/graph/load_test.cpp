#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "graph/graph.h"
#include "tests/graph/toy_nodes.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

using testing::HasSubstr;

/// A folder of graph files that vanishes with the test.
class Load : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) { return temporary.write(name, text); }
  std::optional<Graph> load(const std::string& text, std::vector<std::string> sets = {}) {
    diagnostics = {};
    return load_graph(write("g.json", text), registry, diagnostics, {std::move(sets)});
  }
  void expect_error(const std::string& text, const std::string& where, const std::string& what,
                    std::vector<std::string> sets = {}) {
    EXPECT_FALSE(load(text, std::move(sets)));
    EXPECT_THAT(diagnostics.str(), HasSubstr(where + ": error: "));
    EXPECT_THAT(diagnostics.str(), HasSubstr(what));
  }

  Registry registry = toy::registry();
  Diagnostics diagnostics;
  const test::TemporaryFolder temporary;
  const std::filesystem::path folder = temporary.path();
};

const char* const train_then_apply = R"({
  "parameters": { "n": { "default": 4, "doc": "how many" } },
  "nodes": {
    "late":  { "type": "toy.add", "in": { "a": "items.n", "b": "total.sum" } },
    "items": { "type": "toy.count", "params": { "to": "${n}" } },
    "total": { "type": "toy.sum", "in": { "all": "items" } }
  },
  "outputs": { "all": "late.sum", "total": "total.sum" }
})";

TEST_F(Load, SortsNodesAndFindsDomains) {
  const auto graph = load(train_then_apply);
  ASSERT_TRUE(graph) << diagnostics.str();
  ASSERT_EQ(graph->nodes.size(), 3u);
  EXPECT_EQ(graph->nodes[0].name, "items");
  EXPECT_EQ(graph->nodes[0].domain, -1);
  EXPECT_EQ(graph->nodes[1].name, "total");
  EXPECT_EQ(graph->nodes[1].domain, -1);
  EXPECT_TRUE(graph->nodes[1].inputs[0].gathers_stream);
  EXPECT_EQ(graph->nodes[2].domain, 0);
  EXPECT_EQ(graph->nodes[0].functor->parameters()["to"], 4);
}

TEST_F(Load, AnInputOfAnyTypeTakesEveryPort) {
  const auto graph = load(R"({ "nodes": {
    "items": { "type": "toy.count" },
    "word": { "type": "toy.spell", "in": { "n": "items" } },
    "a": { "type": "toy.note", "in": { "value": "items" } },
    "b": { "type": "toy.note", "in": { "value": "word" } } } })");
  ASSERT_TRUE(graph) << diagnostics.str();
  EXPECT_EQ(graph->nodes.size(), 4u);
  expect_error(R"({ "nodes": { "a": { "type": "toy.note" } } })", "g.json:1:14", "input \"value\" (any) is not wired");
  expect_error(
      R"({ "inputs": { "x": "any" }, "nodes": { "a": { "type": "toy.note", "in": { "value": "inputs.x" } } } })",
      "g.json:1:20", "any");
}

TEST_F(Load, ProvenanceIsWhatANodeDependsOnAndRunsAgain) {
  const auto graph = load(R"({ "nodes": {
    "items": { "type": "toy.count" },
    "other": { "type": "toy.spell", "in": { "n": "total" } },
    "total": { "type": "toy.sum", "in": { "all": "items" } },
    "note": { "type": "toy.note", "in": { "value": "total" } } }, "outputs": { "other": "other" }, "seed": 5 })");
  ASSERT_TRUE(graph) << diagnostics.str();
  const auto index =
      std::find_if(graph->nodes.begin(), graph->nodes.end(), [](const auto& n) { return n.name == "note"; });
  const Provenance made = provenance(*graph, static_cast<int>(index - graph->nodes.begin()));
  EXPECT_EQ(made.node, "note");
  const auto again = load(made.graph);
  ASSERT_TRUE(again) << diagnostics.str();
  EXPECT_EQ(again->nodes.size(), 3u);
  EXPECT_EQ(again->seed, 5u);
  EXPECT_EQ(again->resolved["nodes"]["total"], graph->resolved["nodes"]["total"]);
  EXPECT_EQ(again->resolved["outputs"], (Json{{"what", "note.what"}}));
}

TEST_F(Load, NullTakesNodesWiresAndOutputsAway) {
  const std::string text = R"({ "nodes": { "a": { "type": "toy.count" }, "b": { "type": "toy.count" },
    "c": { "type": "toy.add", "in": { "a": "a", "b": "a" } } }, "outputs": { "x": "c", "y": "b" } })";
  const auto graph = load(text, {"nodes.b=null", "outputs.y=null", "nodes.c.in.b=null"});
  ASSERT_TRUE(graph) << diagnostics.str();
  EXPECT_EQ(graph->outputs.size(), 1u);
  EXPECT_FALSE(graph->resolved["nodes"].contains("b"));
  EXPECT_EQ(graph->resolved["nodes"]["c"]["in"].size(), 1u);
  expect_error(text, "g.json:2:93", "there is no node \"b\"", {"nodes.b=null"});
}

TEST_F(Load, WhatNullTakesAwayIsThere) {
  write("inner.json", R"({ "inputs": { "x": "Number", "extra": { "type": "Number", "optional": true } },
    "nodes": { "s": { "type": "toy.add", "in": { "a": "inputs.x", "b": "inputs.extra" } } }, "outputs": { "y": "s" } })");
  const std::string text = R"({ "nodes": { "items": { "type": "toy.count" },
    "sum": { "type": "toy.add", "in": { "a": "items" } },
    "f": { "graph": "inner.json", "in": { "x": "items" } } }, "outputs": { "x": "sum", "y": "f" } })";
  expect_error(text, "--set:1:1", "there is no \"smu\" to take away (did you mean \"sum\"?)", {"nodes.smu=null"});
  expect_error(text, "--set:1:1", "there is no \"z\" to take away (did you mean", {"outputs.z=null"});
  expect_error(text, "--set:1:1", "toy.add has no input \"c\"", {"nodes.sum.in.c=null"});
  expect_error(text, "--set:1:1", "unknown input \"extar\" (did you mean \"extra\"?)", {"nodes.f.in.extar=null"});
  expect_error(text, "g.json:3:5", "input \"x\" (Number) is not wired", {"nodes.f.in.x=null"});
  const auto open = load(text, {"nodes.sum.in.b=null", "nodes.f.in.extra=null"});
  EXPECT_TRUE(open) << diagnostics.str();
}

TEST_F(Load, NoTwoNodesHaveOneName) {
  write("inner.json", R"({ "nodes": { "b": { "type": "toy.constant" } }, "outputs": { "y": "b" } })");
  expect_error(R"({ "nodes": { "a": { "graph": "inner.json" }, "a/b": { "type": "toy.constant" } },
    "outputs": { "x": "a", "y": "a/b" } })",
               "g.json:1:46", "node \"a/b\" stands twice: here and in a graph used as a node");
}

TEST_F(Load, RefusesWhatIsNestedTooDeeply) {
  const std::string open(200'000, '[');
  expect_error(open, "g.json:1:201", "more than 200 lists and objects within each other");
  expect_error(R"({ "nodes": { "a": {"type": "toy.constant", "params": { "x": )" + open, "g.json:1:257",
               "more than 200");
  expect_error(R"({ "nodes": { "a": { "type": "toy.constant" } }, "outputs": { "x": "a" } })", "--set:1:1",
               "must be a number", {"nodes.a.params.x=" + open.substr(0, 300) + std::string(300, ']')});
}

TEST_F(Load, SetsParametersAndPaths) {
  auto graph = load(train_then_apply, {"n=7"});
  ASSERT_TRUE(graph) << diagnostics.str();
  EXPECT_EQ(graph->nodes[0].functor->parameters()["to"], 7);
  graph = load(train_then_apply, {"nodes.items.params.to=9", "nodes.late.params.bias=0.5"});
  ASSERT_TRUE(graph) << diagnostics.str();
  EXPECT_EQ(graph->nodes[0].functor->parameters()["to"], 9);
  EXPECT_EQ(graph->nodes[2].functor->parameters()["bias"], 0.5);
  expect_error(train_then_apply, "--set:1:1", "no parameter \"m\" to set (did you mean \"n\"?)", {"m=7"});
  expect_error(train_then_apply, "--set:1:1", "there is no \"itms\" to set (did you mean \"items\"?)",
               {"nodes.itms.params.to=7"});
  expect_error(train_then_apply, "--set:1:1", "must be at least 0, got -1", {"n=-1"});
  expect_error(train_then_apply, "--set:1:1", "takes path=value", {"n"});
}

TEST_F(Load, UsesAGraphAsANode) {
  write("fragments/twice.json", R"({
    "parameters": { "bias": { "default": 1 }, "what": {} },
    "inputs": { "x": "Number", "extra": { "type": "Number", "optional": true } },
    "nodes": {
      "c": { "type": "toy.constant", "params": { "x": "${what}", "file": "data.bin" } },
      "one": { "type": "toy.add", "in": { "a": "inputs.x", "b": "inputs.extra" }, "params": { "bias": "${bias}" } },
      "two": { "type": "toy.add", "in": { "a": "one", "b": "c" } }
    },
    "outputs": { "y": "two.sum" }
  })");
  const auto graph = load(R"({
    "nodes": {
      "items": { "type": "toy.count" },
      "f": { "graph": "fragments/twice.json", "in": { "x": "items.n" }, "params": { "what": 5 } },
      "total": { "type": "toy.sum", "in": { "all": "f.y" } }
    },
    "outputs": { "total": "total" }
  })");
  ASSERT_TRUE(graph) << diagnostics.str();
  ASSERT_EQ(graph->nodes.size(), 5u);
  const auto named = [&](const std::string& name) {
    for (const auto& n : graph->nodes)
      if (n.name == name) return &n;
    return static_cast<const Graph::Node*>(nullptr);
  };
  ASSERT_TRUE(named("f/two"));
  EXPECT_EQ(named("f/two")->domain, 0);
  EXPECT_TRUE(named("f/one")->inputs[1].sources.empty());
  EXPECT_EQ(named("f/c")->domain, -1);
  EXPECT_EQ(named("f/c")->functor->parameters()["file"], (folder / "fragments/data.bin").string());

  // What a run folder keeps is a graph that loads again and means the same.
  Diagnostics again;
  const auto resolved = load_graph_text("resolved.json", graph->resolved.dump(), registry, again);
  ASSERT_TRUE(resolved) << again.str();
  EXPECT_EQ(resolved->resolved, graph->resolved);
}

TEST_F(Load, LeavesAnInputOpenThatAParameterSetsToNull) {
  const std::string text = R"({ "parameters": { "a": { "default": "items" }, "b": { "default": "items.n" } },
    "nodes": { "items": { "type": "toy.count" }, "s": { "type": "toy.add", "in": { "a": "${a}", "b": "${b}" } } },
    "outputs": { "y": "s" } })";
  const auto wired = load(text), open = load(text, {"b=null"});
  ASSERT_TRUE(wired && open) << diagnostics.str();
  EXPECT_EQ(wired->nodes[1].inputs[1].sources.size(), 1u);
  EXPECT_TRUE(open->nodes[1].inputs[1].sources.empty());
  expect_error(text, "g.json:2:50", "node \"s\": input \"a\" (Number) is not wired", {"a=null"});
}

TEST_F(Load, SetsWhatStandsInGraphsUsedAsNodes) {
  write("inner.json", R"({ "parameters": { "k": { "default": 1 } },
    "nodes": { "c": { "type": "toy.constant", "params": { "x": "${k}" } }, "d": { "type": "toy.constant" },
               "s": { "type": "toy.add", "in": { "a": "c", "b": "d" } } }, "outputs": { "y": "s" } })");
  write("outer.json", R"({ "nodes": { "in": { "graph": "inner.json" }, "again": { "graph": "inner.json" },
    "s": { "type": "toy.add", "in": { "a": "in", "b": "again" } } }, "outputs": { "y": "s" } })");
  const std::string text = R"({ "nodes": { "f": { "graph": "outer.json" } }, "outputs": { "y": "f" } })";
  auto graph = load(text, {"nodes.f/in/c.params.x=7", "nodes.f/again.params.k=8", "nodes.f/in/s.in.b=null"});
  ASSERT_TRUE(graph) << diagnostics.str();
  EXPECT_EQ(graph->resolved["nodes"]["f/in/c"]["params"]["x"], 7);
  EXPECT_EQ(graph->resolved["nodes"]["f/again/c"]["params"]["x"], 8);
  EXPECT_FALSE(graph->resolved["nodes"].contains("f/in/d"));
  // The same path counts where graphs are spliced in already.
  Diagnostics flat;
  const auto again =
      load_graph_text("resolved.json", graph->resolved.dump(), registry, flat, {{"nodes.f/in/c.params.x=9"}});
  ASSERT_TRUE(again) << flat.str();
  EXPECT_EQ(again->resolved["nodes"]["f/in/c"]["params"]["x"], 9);

  expect_error(text, "--set:1:1", "there is no \"g\" to set (did you mean \"f\"?)", {"nodes.g/in/c.params.x=7"});
  expect_error(text, "--set:1:1", "there is no \"agian\" in \"f\" to set (did you mean \"again\"?)",
               {"nodes.f/agian/c.params.x=7"});
  expect_error(text, "--set:1:1", "there is no \"cc\" in \"f/in\" to set (did you mean \"c\"?)",
               {"nodes.f/in/cc.params.x=7"});
  expect_error(text, "--set:1:1", "\"f/s\" is a node, not a graph with a node \"c\"", {"nodes.f/s/c.params.x=7"});
  expect_error(text, "--set:1:1", "did you mean \"x\"?", {"nodes.f/in/c.params.xx=7"});
  expect_error(text, "--set:1:1", "\"f\" is no graph any more to set in",
               {"nodes.f/in/c.params.x=7", R"(nodes.f={"type": "toy.constant"})"});
}

TEST_F(Load, ChecksAFragmentByItself) {
  const auto graph = load(R"({
    "inputs": { "x": "Number", "many": "Stream<Number>" },
    "nodes": { "s": { "type": "toy.sum", "in": { "all": "inputs.many" } },
               "a": { "type": "toy.add", "in": { "a": "inputs.x", "b": "s" } } },
    "outputs": { "y": "a" } })");
  EXPECT_TRUE(graph) << diagnostics.str();
  expect_error(R"({ "inputs": { "x": "Nmber" }, "nodes": {} })", "g.json:1:20", "did you mean \"Number\"?");
}

TEST_F(Load, CollectsNamedSingleValues) {
  const auto graph = load(R"({ "nodes": {
    "a": { "type": "toy.constant" }, "b": { "type": "toy.constant" },
    "s": { "type": "toy.sum", "in": { "all": { "first": "a.n", "second": "b" } } } }, "outputs": { "s": "s" } })");
  ASSERT_TRUE(graph) << diagnostics.str();
  EXPECT_EQ(graph->nodes.back().inputs[0].names, (std::vector<std::string>{"first", "second"}));
  EXPECT_FALSE(graph->nodes.back().inputs[0].gathers_stream);
}

TEST_F(Load, CollectsNothingWhereToldSo) {
  const auto graph =
      load(R"({ "nodes": { "s": { "type": "toy.sum", "in": { "all": {} } } }, "outputs": { "s": "s" } })");
  ASSERT_TRUE(graph) << diagnostics.str();
  EXPECT_EQ(graph->resolved["nodes"]["s"]["in"], Json::parse(R"({ "all": {} })")) << "it must load again";
}

TEST_F(Load, ExtendsAnotherGraph) {
  write("base.json", R"({ "parameters": { "k": { "default": 1, "doc": "d" } }, "nodes": {
    "a": { "type": "toy.constant", "params": { "x": "${k}" } }, "b": { "type": "toy.constant" } }, "outputs": { "a": "a", "b": "b" } })");
  const auto graph = load(R"({ "extends": "base.json", "parameters": { "k": { "default": 7 } },
    "nodes": { "b": null }, "outputs": { "b": null, "again": "a" } })");
  ASSERT_TRUE(graph) << diagnostics.str();
  ASSERT_EQ(graph->nodes.size(), 1u);
  EXPECT_EQ(graph->resolved["nodes"]["a"]["params"]["x"], 7);
  EXPECT_EQ(graph->outputs.size(), 2u);
}

TEST_F(Load, ExtendsInTurnsAndInFragments) {
  write("one.json",
        R"({ "nodes": { "a": { "type": "toy.constant", "params": { "x": 1 } } }, "outputs": { "n": "a" } })");
  write("two.json", R"({ "extends": "one.json", "nodes": { "a": { "params": { "x": 2 } } } })");
  write("three.json", R"({ "extends": "two.json", "description": "three" })");
  const auto graph = load(R"({ "nodes": { "f": { "graph": "three.json" } }, "outputs": { "n": "f" } })");
  ASSERT_TRUE(graph) << diagnostics.str();
  EXPECT_EQ(graph->resolved["nodes"]["f/a"]["params"]["x"], 2);
}

TEST_F(Load, SaysWhatIsWrongWithAnExtension) {
  write("base.json", R"({ "nodes": { "alpha": { "type": "toy.constant" } }, "outputs": { "n": "alpha" } })");
  expect_error(R"({ "extends": "base.json", "nodes": { "alhpa": null } })", "g.json:1:38",
               "null takes \"nodes.alhpa\" away, but what this is laid over has none (did you mean \"alpha\"?)");
  expect_error(R"({ "extends": "bas.json" })", "g.json:1:14", "did you mean \"base.json\"?");
  expect_error(R"({ "extends": "g.json" })", "g.json:1:14", "");
  write("x.json", R"({ "extends": "y.json" })");
  write("y.json", R"({ "extends": "x.json" })");
  expect_error(R"({ "extends": "x.json" })", "y.json:1:14", "extends itself");
}

TEST_F(Load, MakesANodeLikeAnother) {
  write("sum.json", R"({ "inputs": { "a": "Number", "b": "Number" }, "parameters": { "k": { "default": 1 } }, "nodes": {
    "k": { "type": "toy.constant", "params": { "x": "${k}" } },
    "s": { "type": "toy.add", "in": { "a": "inputs.a", "b": "inputs.b" } } }, "outputs": { "n": "s", "k": "k" } })");
  const std::string text = R"({ "parameters": { "two": { "default": 2 } }, "nodes": {
    "third": { "like": "second", "in": { "b": "second.n" } },
    "first": { "graph": "sum.json", "in": { "a": "one", "b": "one" }, "params": { "k": "${two}" } },
    "second": { "like": "first", "in": { "b": "first.n" }, "params": { "k": 3 } },
    "one": { "type": "toy.constant", "params": { "x": 1 } } }, "outputs": { "n": "third.n", "k1": "first.k", "k3": "third.k" } })";
  const auto graph = load(text);
  ASSERT_TRUE(graph) << diagnostics.str();
  const Json nodes = graph->resolved["nodes"];
  EXPECT_EQ(nodes["third/s"]["in"], Json::parse(R"({ "a": "one.n", "b": "second/s.sum" })"));
  EXPECT_EQ(nodes["second/s"]["in"], Json::parse(R"({ "a": "one.n", "b": "first/s.sum" })"));
  EXPECT_EQ(nodes["first/k"]["params"]["x"], 2);
  EXPECT_EQ(nodes["third/k"]["params"]["x"], 3);

  const auto set = load(text, {"nodes.third/k.params.x=9", "nodes.first.params.k=5", "nodes.third.in.a=second.n"});
  ASSERT_TRUE(set) << diagnostics.str();
  EXPECT_EQ(set->resolved["nodes"]["third/k"]["params"]["x"], 9);
  EXPECT_EQ(set->resolved["nodes"]["third/s"]["in"]["a"], "second/s.sum");
  EXPECT_EQ(set->resolved["nodes"]["first/k"]["params"]["x"], 5);
}

TEST_F(Load, LaysAnotherGraphOverBeforeItCopiesNodes) {
  write("base.json", R"({ "nodes": { "a": { "type": "toy.constant", "params": { "x": 6 } }, "b": { "like": "a" } },
    "outputs": { "n": "b" } })");
  const auto graph = load(R"({ "extends": "base.json", "nodes": { "a": { "params": { "x": 4 } } } })");
  ASSERT_TRUE(graph) << diagnostics.str();
  EXPECT_EQ(graph->resolved["nodes"]["b"]["params"]["x"], 4);
  EXPECT_EQ(graph->nodes.size(), 1u) << "what is only copied is not run";
  const auto back = load(R"({ "extends": "base.json", "nodes": { "b": { "params": { "x": null } } } })");
  ASSERT_TRUE(back) << diagnostics.str();
  EXPECT_EQ(back->resolved["nodes"]["b"]["params"]["x"], 1) << "back to its default";
}

TEST_F(Load, SaysWhatIsWrongWithALikeness) {
  expect_error(R"({ "nodes": { "alpha": { "type": "toy.constant" }, "b": { "like": "alhpa" } } })", "g.json:1:66",
               "node \"b\" is like \"alhpa\", which is no node here (did you mean \"alpha\"?)");
  expect_error(R"({ "nodes": { "a": { "like": "a" } } })", "g.json:1:29", "node \"a\" is like itself");
  expect_error(R"({ "nodes": { "a": { "like": "b" }, "b": { "like": "a" } } })", "g.json:1:51", "is like itself");
  expect_error(R"({ "nodes": { "a": { "like": 3 } } })", "g.json:1:29", "the name of a node");
  expect_error(R"({ "nodes": { "a": { "type": "toy.constant" }, "b": { "like": "a", "graph": "x.json" } } })",
               "g.json:1:47", "must have either");
  expect_error(R"({ "nodes": { "a": { "like": "b" }, "b": { "like": "a" } } })", "--set:1:1",
               "\"a\" is a node, not a graph", {"nodes.a/c.params.x=1"});
}

TEST_F(Load, DropsNodesNobodyNeeds) {
  const auto graph = load(R"({ "nodes": { "a": { "type": "toy.constant" }, "b": { "type": "toy.constant" } },
                               "outputs": { "a": "a" } })");
  ASSERT_TRUE(graph);
  EXPECT_EQ(graph->nodes.size(), 1u);
}

TEST_F(Load, EmbedsAGraphGivenAsAParameter) {
  write("speak.json", R"({ "parameters": { "k": { "default": 1 } },
    "nodes": { "c": { "type": "toy.constant", "params": { "x": "${k}" } } }, "outputs": { "n": "c" } })");
  const auto graph = load(R"({ "nodes": { "a": { "type": "toy.constant", "params":
    { "inner": { "graph": "speak.json", "params": { "k": 8 } } } } }, "outputs": { "a": "a" } })");
  ASSERT_TRUE(graph) << diagnostics.str();
  const auto inner = Json::parse(graph->nodes[0].functor->parameters()["inner"].get<std::string>());
  EXPECT_EQ(inner["nodes"]["c"]["params"]["x"], 8.0);
}

TEST_F(Load, ReportsBadJsonWithItsPlace) {
  expect_error("{\n  \"nodes\": {,}\n}", "g.json:2:13", "not valid JSON");
  expect_error("", "g.json:1:1", "not valid JSON");
  expect_error("[1]", "g.json:1:1", "must be an object, got a list");
  expect_error("{ \"nodes\": {}, \"nodes\": {} }", "g.json:1:16", "\"nodes\" stands twice");
  EXPECT_FALSE(load_graph(folder / "h.json", registry, diagnostics));
  EXPECT_THAT(diagnostics.str(), HasSubstr("did you mean \"g.json\"?"));
}

TEST_F(Load, ReportsUnknownNames) {
  expect_error(R"({ "nodes": { "a": { "type": "toy.cuont" } } })", "g.json:1:29", "did you mean \"toy.count\"?");
  expect_error(R"({ "nodes": { "a": { "typ": "toy.count" } } })", "g.json:1:21",
               "unknown key \"typ\" (did you mean \"type\"?)");
  expect_error(R"({ "nodes": { "a": { "type": "toy.count", "params": { "too": 1 } } } })", "g.json:1:54",
               "did you mean \"to\"?");
  expect_error(R"({ "nodes": { "a": { "type": "toy.spell", "in": { "m": "a" } } } })", "g.json:1:50",
               "has no input \"m\" (did you mean \"n\"?)");
  expect_error(
      R"({ "nodes": { "a": { "type": "toy.spell", "in": { "n": "bb.n" } }, "b": { "type": "toy.constant" } } })",
      "g.json:1:55", "there is no node \"bb\" (did you mean \"b\"?)");
  expect_error(
      R"({ "nodes": { "a": { "type": "toy.spell", "in": { "n": "b.m" } }, "b": { "type": "toy.constant" } } })",
      "g.json:1:55", "has no output \"m\" (did you mean \"n\"?)");
  expect_error(R"({ "nodes": { "a": { "graph": "nowhere.json" } } })", "g.json:1:30", "unknown graph");
  expect_error(R"({ "nodes": { "a": { "type": "toy.count", "params": { "to": "${t}" } } } })", "g.json:1:60",
               "unknown parameter ${t}");
  expect_error(R"({ "nodes": { "a": { } } })", "g.json:1:14", "either a \"type\" or a \"graph\"");
}

TEST_F(Load, ReportsWrongWiring) {
  expect_error(R"({ "nodes": { "a": { "type": "toy.spell" } } })", "g.json:1:14", "input \"n\" (Number) is not wired");
  expect_error(R"({ "nodes": { "c": { "type": "toy.constant" }, "a": { "type": "toy.spell", "in": { "n": "c" } },
    "b": { "type": "toy.spell", "in": { "n": "a.word" } } } })",
               "g.json:2:46", "takes Number, but \"a.word\" gives Word");
  expect_error(R"({ "nodes": { "a": { "type": "toy.add", "in": { "a": "b" } },
    "b": { "type": "toy.add", "in": { "a": "a" } } }, "outputs": { "x": "a" } })",
               "g.json:1:14", "form a cycle: a <- b <- a");
  expect_error(R"({ "nodes": { "x": { "type": "toy.count" }, "y": { "type": "toy.count" },
    "z": { "type": "toy.add", "in": { "a": "x", "b": "y" } } } })",
               "g.json:2:5", "come from different streams, \"x\" and \"y\"");
  expect_error(R"({ "nodes": { "c": { "type": "toy.constant" }, "s": { "type": "toy.sum", "in": { "all": "c" } } } })",
               "g.json:1:47", "is a single value");
}

TEST_F(Load, ReportsEverythingInOneGo) {
  load(R"({ "nodes": {
    "a": { "type": "toy.cuont" },
    "b": { "type": "toy.constant", "params": { "x": 1000 } },
    "c": { "type": "toy.spell" } } })");
  EXPECT_EQ(diagnostics.messages().size(), 3u) << diagnostics.str();
}

TEST_F(Load, ReportsCyclesAndDomainsBesideOtherErrors) {
  load(R"({ "nodes": {
    "a": { "type": "toy.add", "in": { "a": "b" } }, "b": { "type": "toy.add", "in": { "a": "a" } },
    "c": { "type": "toy.add", "in": { "a": "d" } }, "d": { "type": "toy.add", "in": { "a": "c" } },
    "behind": { "type": "toy.sum", "in": { "all": "a" } },
    "x": { "type": "toy.count" }, "y": { "type": "toy.count" },
    "z": { "type": "toy.add", "in": { "a": "x", "b": "y" } },
    "w": { "type": "toy.cuont" }, "v": { "type": "toy.sum", "in": { "all": "w" } } } })");
  const std::string all = diagnostics.str();
  EXPECT_EQ(diagnostics.messages().size(), 4u) << all;
  EXPECT_THAT(all, HasSubstr("form a cycle: a <- b <- a"));
  EXPECT_THAT(all, HasSubstr("form a cycle: c <- d <- c"));
  EXPECT_THAT(all, HasSubstr("come from different streams"));
  EXPECT_THAT(all, HasSubstr("toy.cuont"));
}

TEST_F(Load, RefusesAGraphThatContainsItself) {
  write("loop.json", R"({ "nodes": { "a": { "graph": "loop.json" } } })");
  expect_error(R"({ "nodes": { "l": { "graph": "loop.json" } } })", "loop.json:1:30", "contains itself");
}

}  // namespace
}  // namespace talkgraph
