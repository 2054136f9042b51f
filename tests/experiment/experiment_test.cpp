#include "experiment/experiment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/experiment/scored_nodes.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class ExperimentFile : public testing::Test {
 protected:
  ExperimentFile() { folder_.write("graph.json", test::scored_graph); }

  /// An experiment whose file has these members beside "graph" and "tabulate".
  std::optional<Experiment> load(const std::string& members, Diagnostics& diagnostics) {
    const auto file = folder_.write(
        "e.json", R"({ "graph": "graph.json", "tabulate": ["scores"])" + (members.empty() ? "" : ", " + members) + "}");
    return load_experiment(file, diagnostics);
  }
  Experiment sound(const std::string& members) {
    Diagnostics diagnostics;
    auto experiment = load(members, diagnostics);
    EXPECT_TRUE(experiment) << diagnostics.str();
    return experiment.value_or(Experiment{});
  }
  std::string complaint(const std::string& members) {
    Diagnostics diagnostics;
    EXPECT_FALSE(load(members, diagnostics));
    return diagnostics.str();
  }
  /// The values of a factor, each once, in the order of the trials.
  std::vector<double> values(const std::string& factor_json) {
    std::vector<double> out;
    for (const auto& trial : sound("\"vary\": { \"scale\": " + factor_json + " }").trials)
      out.push_back(trial.levels.at(0).get<double>());
    return out;
  }

  const test::TemporaryFolder folder_;
};

TEST_F(ExperimentFile, WithoutVariationIsOneTrial) {
  const auto e = sound("");
  ASSERT_EQ(e.trials.size(), 1u);
  EXPECT_EQ(e.name, "e");
  EXPECT_EQ(e.trials[0].name, "run");
  EXPECT_FALSE(e.trials[0].seed);
}

TEST_F(ExperimentFile, CombinesFactorsTheSeedFastest) {
  const auto e = sound(R"("vary": { "scale": [1, 2], "offset": [0, 5] }, "repeats": 2)");
  EXPECT_THAT(e.factors, ElementsAre("scale", "offset"));
  ASSERT_EQ(e.trials.size(), 8u);
  EXPECT_EQ(e.settings, 4u);
  EXPECT_EQ(e.trials[0].name, "scale=1,offset=0,seed=1");
  EXPECT_EQ(e.trials[1].name, "scale=1,offset=0,seed=2");
  EXPECT_EQ(e.trials[2].name, "scale=1,offset=5,seed=1");
  EXPECT_EQ(e.trials[7].name, "scale=2,offset=5,seed=2");
  EXPECT_EQ(e.trials[2].setting, 1u);
  EXPECT_EQ(e.trials[7].setting, 3u);
}

TEST_F(ExperimentFile, RangesIncludeBothEnds) {
  EXPECT_THAT(values(R"({ "from": 1, "to": 4, "step": 1 })"), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(values(R"({ "from": 0.1, "to": 0.3, "step": 0.1 })"), ElementsAre(0.1, 0.2, 0.3));
  EXPECT_THAT(values(R"({ "from": 1, "to": 2, "step": 0.7 })"), ElementsAre(1, 1.7));
  EXPECT_THAT(values(R"({ "from": 5, "to": 1, "count": 3 })"), ElementsAre(5, 3, 1));
  EXPECT_THAT(values(R"({ "from": 0.01, "to": 100, "count": 5, "scale": "log" })"), ElementsAre(0.01, 0.1, 1, 10, 100));
  EXPECT_THAT(values(R"({ "from": 7, "to": 9, "count": 1 })"), ElementsAre(7));
  EXPECT_THAT(values(R"({ "values": [3, 1] })"), ElementsAre(3, 1));
}

TEST_F(ExperimentFile, WholeNumbersOfARangeStayWhole) {
  EXPECT_TRUE(
      sound(R"("vary": { "scale": { "from": 1, "to": 2, "step": 1 } })").trials[0].levels[0].is_number_integer());
}

TEST_F(ExperimentFile, AFactorMayHaveAShortNameForALongPath) {
  const auto e = sound(R"("vary": { "s": { "path": "nodes.score.params.scale", "values": [4] } })");
  EXPECT_THAT(e.factors, ElementsAre("s"));
  EXPECT_EQ(e.trials[0].changes[0].path, "nodes.score.params.scale");
}

TEST_F(ExperimentFile, NamedLevelsAreSetsOfChanges) {
  const auto e = sound(R"("vary": { "kind": { "levels": { "plain": {}, "shifted": { "scale": 2, "offset": 3 } } } })");
  ASSERT_EQ(e.trials.size(), 2u);
  EXPECT_EQ(e.trials[0].levels[0], "plain");
  EXPECT_TRUE(e.trials[0].changes.empty());
  EXPECT_EQ(e.trials[1].changes.size(), 2u);
}

TEST_F(ExperimentFile, ListsMoveTogether) {
  const auto e = sound(R"("vary": { "pair": { "together": { "scale": [1, 2], "offset": [10, 20] } } })");
  EXPECT_THAT(e.factors, ElementsAre("scale", "offset"));
  ASSERT_EQ(e.trials.size(), 2u);
  EXPECT_THAT(e.trials[1].levels, ElementsAre(Json(2), Json(20)));
}

TEST_F(ExperimentFile, NamesAreFolderNamesAndDiffer) {
  const std::string longer(300, 'x');
  const auto e = sound(R"("vary": { "title": ["a/b", "a b", "a-b", ")" + longer + R"(1", ")" + longer + R"(2"] })");
  std::set<std::string> names;
  for (const auto& trial : e.trials) {
    EXPECT_EQ(trial.name.find_first_of("/ "), std::string::npos);
    EXPECT_LE(trial.name.size(), 100u);
    names.insert(trial.name);
  }
  EXPECT_EQ(names.size(), e.trials.size());
}

TEST_F(ExperimentFile, ATrialKeepsItsNameWhenTheExperimentGrows) {
  const auto before = sound(R"("vary": { "scale": [2] })"), after = sound(R"("vary": { "scale": [1, 2] })");
  EXPECT_EQ(before.trials[0].name, after.trials[1].name);
}

TEST_F(ExperimentFile, MistakesAreLocated) {
  EXPECT_THAT(complaint(R"("vry": {})"), HasSubstr("unknown key \"vry\" (did you mean \"vary\"?)"));
  EXPECT_THAT(complaint(R"("vary": { "scale": [] })"), HasSubstr("e.json:1:69: error: \"scale\" has no values"));
  EXPECT_THAT(complaint(R"("vary": { "scale": [1, 1] })"), HasSubstr("has the value 1 twice"));
  EXPECT_THAT(complaint(R"("vary": { "scale": 3 })"), HasSubstr("must be a list or a range, got 3"));
  EXPECT_THAT(complaint(R"("vary": { "scale": { "from": 1 } })"), HasSubstr("needs \"from\", \"to\""));
  EXPECT_THAT(complaint(R"("vary": { "scale": { "from": 1, "to": 2, "step": 1, "count": 2 } })"), HasSubstr("either"));
  EXPECT_THAT(complaint(R"("vary": { "scale": { "from": 2, "to": 1, "step": 1 } })"), HasSubstr("must not be below"));
  EXPECT_THAT(complaint(R"("vary": { "scale": { "from": 0, "to": 1, "count": 2, "scale": "log" } })"),
              HasSubstr("limits above 0"));
  EXPECT_THAT(complaint(R"("vary": { "scale": { "from": 0, "to": 1, "step": 1e-9 } })"), HasSubstr("more than 10000"));
  EXPECT_THAT(complaint(R"("vary": { "p": { "together": { "scale": [1], "offset": [1, 2] } } })"),
              HasSubstr("must be equally long: scale has 1, offset has 2"));
  EXPECT_THAT(complaint(R"("vary": { "k": { "levels": { "a": 1 } } })"), HasSubstr("level \"a\" must be an object"));
  EXPECT_THAT(complaint(R"("repeats": 2, "seeds": [1])"), HasSubstr("either \"repeats\" or \"seeds\""));
  EXPECT_THAT(complaint(R"("seeds": [1, 1])"), HasSubstr("the same seed twice"));
  EXPECT_THAT(complaint(R"("show": ["files", "files"])"),
              HasSubstr("1:58: error: experiment: \"show\" names an output twice"));
  EXPECT_THAT(complaint(R"("repeats": 5000, "vary": { "scale": [1, 2, 3] })"), HasSubstr("15000 runs"));
}

TEST_F(ExperimentFile, FactorsDoNotCollide) {
  EXPECT_THAT(complaint(R"("vary": { "seed": [1, 2] })"), HasSubstr("e.json:1:60: error: results have a column "
                                                                    "\"seed\" already: name seeds in \"seeds\""));
  EXPECT_THAT(complaint(R"("vary": { "seed": [1, 2] }, "repeats": 2)"), HasSubstr("name seeds in \"seeds\""));
  EXPECT_THAT(complaint(R"("vary": { "s": { "path": "seed", "values": [1, 2] } })"), HasSubstr("sets the seed"));
  EXPECT_THAT(complaint(R"("vary": { "k": { "levels": { "a": { "seed": 1 }, "b": {} } } })"),
              HasSubstr("sets the seed"));
  EXPECT_THAT(complaint(R"("vary": { "measure": { "path": "scale", "values": [1] } })"),
              HasSubstr("results have a column \"measure\" already: give the factor another name"));
  EXPECT_THAT(complaint(R"("vary": { "p": { "path": "scale", "values": [1] } })"),
              HasSubstr("results have a column \"p\" already"));
  EXPECT_THAT(complaint(R"("vary": { "s": { "path": "scale", "values": [1] }, "scale": [1, 2] })"),
              HasSubstr("\"scale\" sets \"scale\", which is set twice then"));
  EXPECT_THAT(complaint(R"("vary": { "parameters.scale.default": [1, 2], "scale": [1, 2] })"), HasSubstr("set twice"));
  EXPECT_THAT(complaint(R"("vary": { "scale": [1], "pair": { "together": { "scale": [1], "offset": [2] } } })"),
              HasSubstr("two factors are called \"scale\""));
  EXPECT_THAT(complaint(R"("vary": { "p": { "together": { "scale": [1], "parameters.scale.default": [2] } } })"),
              HasSubstr("set twice"));
  EXPECT_THAT(complaint(R"("vary": { "a": { "levels": { "x": { "scale": 1 } } }, "scale": [1, 2] })"),
              HasSubstr("set twice"));
}

TEST_F(ExperimentFile, NoTwoRunsAreTheSame) {
  Diagnostics diagnostics;
  EXPECT_FALSE(load_trials(sound(R"("vary": { "nodes.score.params.scale": [1], "scale": [2, 3] })"),
                           test::scored_registry(), diagnostics));
  EXPECT_THAT(diagnostics.str(), HasSubstr("e.json:1:50: error: the runs \"scale=1,scale=2\" and "
                                           "\"scale=1,scale=3\" are the same"));
}

TEST_F(ExperimentFile, RepeatsThatChangeNothingAreRefused) {
  folder_.write("graph.json",
                R"({ "nodes": { "items": { "type": "test.items" } }, "outputs": { "scores": "items" } })");
  Diagnostics diagnostics;
  EXPECT_FALSE(load_trials(sound(R"("repeats": 3)"), test::scored_registry(), diagnostics));
  EXPECT_THAT(diagnostics.str(), HasSubstr("e.json:1:50: error: repeats with other seeds would all give the same"));
  Diagnostics one;
  EXPECT_TRUE(load_trials(sound(R"("seeds": [3])"), test::scored_registry(), one)) << one.str();
}

TEST_F(ExperimentFile, AGraphThatIsNotThereIsToldOfWithItsPlace) {
  Diagnostics diagnostics;
  EXPECT_FALSE(
      load_experiment(folder_.write("x.json", R"({ "graph": "grap.json", "tabulate": ["scores"] })"), diagnostics));
  EXPECT_THAT(diagnostics.str(), HasSubstr("x.json:1:12: error: unknown graph"));
  EXPECT_THAT(diagnostics.str(), HasSubstr("(did you mean \"graph.json\"?)"));
}

TEST_F(ExperimentFile, NeedsAGraphAndSomethingToTabulate) {
  Diagnostics diagnostics;
  EXPECT_FALSE(load_experiment(folder_.write("x.json", "{}"), diagnostics));
  EXPECT_THAT(diagnostics.str(), HasSubstr("\"graph\" must name"));
  EXPECT_THAT(diagnostics.str(), HasSubstr("\"tabulate\" must name"));
  Diagnostics missing;
  EXPECT_FALSE(load_experiment(folder_.file("none.json"), missing));
  EXPECT_THAT(missing.str(), HasSubstr("none.json: cannot be read"));
}

TEST_F(ExperimentFile, MayExtendAnother) {
  folder_.write("base.json",
                R"({ "graph": "graph.json", "tabulate": ["scores"], "plot": ["acc"], "set": { "nodes.a": 1 },
    "vary": { "scale": [1, 2] } })");
  const auto file = folder_.write("grid/more.json", R"({ "extends": "../base.json", "plot": null, "repeats": 2,
    "set": { "nodes.b": 2 } })");
  Diagnostics diagnostics;
  const auto e = load_experiment(file, diagnostics);
  ASSERT_TRUE(e) << diagnostics.str();
  EXPECT_EQ(e->name, "more");
  EXPECT_EQ(e->graph, folder_.file("graph.json"));
  EXPECT_EQ(e->trials.size(), 4u);
  EXPECT_EQ(e->set.size(), 2u);
  EXPECT_EQ(e->trials[0].changes.size(), 2u);
  EXPECT_TRUE(e->plot.empty());
}

TEST_F(ExperimentFile, EveryTrialIsCheckedAndAMistakeToldOnce) {
  const Registry registry = test::scored_registry();
  const auto complaint_of_trials = [&](const std::string& members) {
    Diagnostics diagnostics;
    EXPECT_FALSE(load_trials(sound(members), registry, diagnostics));
    return diagnostics.str();
  };
  const auto unknown = complaint_of_trials(R"("set": { "scal": 1 }, "vary": { "offset": [1, 2] })");
  EXPECT_THAT(unknown, HasSubstr("no parameter \"scal\" to set (did you mean \"scale\"?)"));
  EXPECT_EQ(unknown.find("scal\" to"), unknown.rfind("scal\" to"));
  EXPECT_THAT(complaint_of_trials(R"("vary": { "nodes.items.params.items": [3, -1] })"),
              HasSubstr("at least 0, got -1"));
  EXPECT_THAT(complaint_of_trials(R"("show": ["pictures"])"), HasSubstr("no such output"));
  EXPECT_THAT(complaint_of_trials(R"("show": ["scores"])"), HasSubstr("is of type Scores, not Artifact or Plot"));
}

TEST_F(ExperimentFile, WhatIsSetInAllRunsReplacesWhatTheFileSets) {
  const auto score = [&](const std::vector<std::string>& sets) {
    Experiment e = sound(R"("set": { "scale": 12, "nodes.score.params.offset": 2 }, "vary": { "noise": [0, 1] })");
    Diagnostics diagnostics;
    set_in_all_runs(e, sets, diagnostics);
    const auto graphs = load_trials(e, test::scored_registry(), diagnostics);
    EXPECT_TRUE(graphs) << diagnostics.str();
    return graphs.value().at(1).resolved["nodes"]["score"]["params"];
  };
  EXPECT_EQ(score({})["scale"], 12);
  EXPECT_EQ(score({"scale=16"})["scale"], 16);
  EXPECT_EQ(score({"parameters.scale.default=16"})["scale"], 16);
  EXPECT_EQ(score({"scale=16", "scale=17"})["scale"], 17);
  EXPECT_EQ(score({"scale=16"})["offset"], 2);
  EXPECT_EQ(score({"scale=16"})["noise"], 1);
  EXPECT_EQ(score({R"(nodes.score.params={"noise": "${noise}"})"})["offset"], 0);
}

TEST_F(ExperimentFile, WhatIsSetHoldsWhereALevelDoesNotVaryIt) {
  const auto e =
      sound(R"("set": { "scale": 12, "nodes.score.params": { "scale": "${scale}" }, "parameters.noise.default": 1,
                                   "seed": 5 },
                          "vary": { "k": { "levels": { "as set": {}, "other": { "parameters.scale.default": 2,
                                                                                "nodes.score.params.offset": 3 } } } },
                          "seeds": [1, 2])");
  Diagnostics diagnostics;
  const auto graphs = load_trials(e, test::scored_registry(), diagnostics);
  ASSERT_TRUE(graphs) << diagnostics.str();
  EXPECT_EQ(graphs->at(0).resolved["nodes"]["score"]["params"]["scale"], 12);
  EXPECT_EQ(graphs->at(2).resolved["nodes"]["score"]["params"]["scale"], 2);
  std::vector<std::string> in_all;
  for (const auto& set : e.set)
    if (!varies(e, set)) in_all.push_back(set.path);
  EXPECT_THAT(in_all, ElementsAre("parameters.noise.default"));
}

TEST_F(ExperimentFile, WhatVariesIsNotSetInAllRuns) {
  const auto complaint_of = [&](const std::string& members, const std::string& set) {
    Experiment e = sound(members);
    Diagnostics diagnostics;
    set_in_all_runs(e, {set}, diagnostics);
    EXPECT_FALSE(load_trials(e, test::scored_registry(), diagnostics));
    return diagnostics.str();
  };
  EXPECT_THAT(complaint_of(R"("vary": { "scale": [1, 2] })", "scale=3"),
              HasSubstr("e.json:1:60: error: --set scale=3 cannot hold in all runs: what it sets varies here"));
  EXPECT_THAT(complaint_of(R"("vary": { "s": { "path": "scale", "values": [1] } })", "parameters.scale.default=3"),
              HasSubstr("e.json:1:60: error: --set"));
  EXPECT_THAT(
      complaint_of(R"("vary": { "k": { "levels": { "a": {}, "b": { "nodes.score.params": { "scale": 2 } } } } })",
                   "nodes.score.params.scale=3"),
      HasSubstr("e.json:1:60: error: --set"));
  EXPECT_THAT(complaint_of(R"("seeds": [1, 2])", "seed=3"), HasSubstr("e.json:1:50: error: --set seed=3 cannot"));
  EXPECT_THAT(complaint_of("", "scale"), HasSubstr("--set takes path=value"));
}

TEST_F(ExperimentFile, FilesInItAreNamedFromItsFolder) {
  folder_.write("below/graph2.json", test::scored_graph);
  const auto file = folder_.write("below/e.json", R"({ "graph": "graph2.json", "tabulate": ["scores"] })");
  Diagnostics diagnostics;
  const auto e = load_experiment(file, diagnostics);
  ASSERT_TRUE(e) << diagnostics.str();
  EXPECT_TRUE(load_trials(*e, test::scored_registry(), diagnostics)) << diagnostics.str();
}

}  // namespace
}  // namespace talkgraph
