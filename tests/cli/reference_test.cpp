#include "cli/reference.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "cli/example.h"
#include "cli/samples.h"
#include "nodes/all_nodes.h"
#include "nodes/media/ffmpeg.h"
#include "nodes/types/audio.h"
#include "nodes/types/phones.h"
#include "nodes/types/track.h"
#include "nodes/types/yardsticks.h"
#include "tests/source_folder.h"
#include "tests/temporary_folder.h"

namespace talkgraph {

struct Secret {};
template <>
inline constexpr PortType port_type<Secret>{"Secret", 1};
void fields(Archive&, Secret&) {}

namespace cli {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(Reference, EveryPortAndParameterSaysWhatItIs) {
  const Registry registry = all_nodes();
  const std::function<void(const std::string&, const std::vector<ParameterSpec>&)> check =
      [&](const std::string& owner, const std::vector<ParameterSpec>& specs) {
        for (const auto& p : specs) {
          EXPECT_FALSE(p.doc.empty()) << owner << ": parameter " << p.name;
          check(owner + "." + p.name, p.members);
        }
      };
  for (const auto& name : registry.names()) {
    const NodeType& type = *registry.find(name);
    EXPECT_NE(name.find('.'), std::string::npos) << name;
    EXPECT_FALSE(type.summary.empty()) << name;
    for (const auto& port : type.inputs) EXPECT_FALSE(port.doc.empty()) << name << ": input " << port.name;
    for (const auto& port : type.outputs) EXPECT_FALSE(port.doc.empty()) << name << ": output " << port.name;
    check(name, type.parameters);
  }
}

TEST(Reference, FindsAndShowsNodeTypes) {
  const Registry registry = all_nodes();
  EXPECT_THAT(list_nodes(registry, "MEL"), HasSubstr("speech.mel"));
  EXPECT_THROW(list_nodes(registry, "zzz"), std::invalid_argument);
  EXPECT_THROW(known_type(registry, "speech.mell"), std::invalid_argument);
  const std::string mel = show_node(registry, known_type(registry, "speech.mel"));
  for (const char* part : {"speech.mel (version ", "source: Thesis §3.2", "integer, 1 to 1000; default 30",
                           "number, Hz, at least 0; default 0.0", "talkgraph node speech.mel --example"})
    EXPECT_THAT(mel, HasSubstr(part));
  EXPECT_THAT(show_node(registry, known_type(registry, "voice.speak")), HasSubstr("      pitch "));
  EXPECT_THAT(show_node(registry, known_type(registry, "media.video")), HasSubstr("talkgraph samples &&"));
}

TEST(Reference, PagesAreUpToDate) {
  const fs::path folder = test::source("/docs/reference");
  const auto pages = reference_pages(all_nodes());
  for (const auto& [name, text] : pages) {
    std::ifstream file(folder / name);
    const std::string there{std::istreambuf_iterator<char>(file), {}};
    EXPECT_TRUE(there == text) << name << " is stale: run build/talkgraph reference -o docs/reference";
  }
  for (const auto& entry : fs::directory_iterator(folder))
    EXPECT_TRUE(pages.contains(entry.path().filename().string())) << entry.path() << ": no such family, remove it";
}

TEST(Reference, ListsTheMembersOfStructsAndOfListsOfThem) {
  const auto pages = reference_pages(all_nodes());
  EXPECT_THAT(pages.at("latent.md"), HasSubstr("| `kernel[].variance` | number |  | above 0 | `1.0` |"));
  EXPECT_THAT(pages.at("voice.md"), HasSubstr("| `voice.pitch` | number |"));
}

TEST(Examples, AreSound) {
  const Registry registry = all_nodes();
  for (const auto& name : registry.names()) {
    const Json example = example_graph(registry, *registry.find(name));
    EXPECT_EQ(example["nodes"].front()["type"], name);
    Diagnostics diagnostics;
    const auto graph = load_graph_text(name, graph_text(example), registry, diagnostics);
    ASSERT_TRUE(graph) << diagnostics.str();
    EXPECT_EQ(graph->nodes.size(), example["nodes"].size()) << name << ": holds what nobody needs";
  }
}

// As a user runs them: in a folder with the samples, one after the other, on results that are kept.
TEST(Examples, Run) {
#ifndef TALKGRAPH_ESPEAK
  GTEST_SKIP() << "built without espeak-ng, which the built-in speaker needs";
#endif
  if (!built_with_ffmpeg) GTEST_SKIP() << "built without FFmpeg, which writes and reads clips";
  const test::TemporaryFolder temporary;
  const Registry registry = all_nodes();
  RunCommand run;
  run.progress = ProgressStyle::quiet;
  run.cached = true;
  run.cache = temporary.path() / "cache";
  run.folder = temporary.path() / "samples";
  ASSERT_EQ(write_samples(run, registry), success);
  for (const auto& name : registry.names()) {
    run.folder = temporary.path() / name;
    const auto graph = graph_text(example_graph(registry, *registry.find(name)));
    EXPECT_EQ(run_file(temporary.write(name + ".json", graph), run, registry), success) << name;
  }
}

/// A type of a plug-in: what it takes and gives is known, and the built-in speaker can feed it.
struct Tone {
  Audio operator()(const Transcript&) const { return {}; }
  std::vector<double> frequencies;
  int harmonics = 0;
};
void describe(Description<Tone>& d) {
  d.type("toy.tone").summary("a tone").input("word").output("audio");
  d.param("frequencies", &Tone::frequencies).required().within(20, 20000).unit("Hz");
  d.param("harmonics", &Tone::harmonics).required().positive();
}

/// A source: it needs single values.
struct Sentences {
  Stream<Audio> operator()(const RidgeModel&, const Collected<Track>&) const {
    return Stream<Audio>(std::vector<Item<Audio>>{});
  }
};
void describe(Description<Sentences>& d) {
  d.type("toy.sentences").summary("makes sentences").input("model").input("tracks").output("audio");
}

/// A source and what takes its items, of a type that nothing else knows.
struct Secrets {
  Stream<Secret> operator()() const { return Stream<Secret>(std::vector<Item<Secret>>{}); }
};
struct Tell {
  Audio operator()(const Secret&) const { return {}; }
};
struct TellBeside {
  Audio operator()(const Secret&, const Track&) const { return {}; }
};
void describe(Description<Secrets>& d) { d.type("toy.secrets").summary("makes secrets").output("secret"); }
void describe(Description<Tell>& d) { d.type("toy.tell").summary("tells one").input("secret").output("audio"); }
void describe(Description<TellBeside>& d) {
  d.type("toy.tell_beside").summary("tells one beside a track").input("secret").input("track").output("audio");
}

// Types of plug-ins stand in no list of examples.
TEST(Examples, AreMadeUpForOtherTypes) {
  Registry registry = all_nodes();
  registry.add<Tone>();
  registry.add<Sentences>();
  registry.add<Secrets>();
  registry.add<Tell>();
  registry.add<TellBeside>();
  for (const char* name : {"toy.tone", "toy.sentences", "toy.secrets", "toy.tell"}) {
    const Json example = example_graph(registry, known_type(registry, name));
    Diagnostics diagnostics;
    EXPECT_TRUE(load_graph_text(name, graph_text(example), registry, diagnostics)) << diagnostics.str();
  }
  const Json tone = example_graph(registry, known_type(registry, "toy.tone"));
  EXPECT_EQ(tone["nodes"]["toy_tone"]["in"]["word"], "parts.transcript");
  EXPECT_EQ(tone["nodes"]["toy_tone"]["params"], Json::parse(R"({ "frequencies": [20.0], "harmonics": 1 })"));
  EXPECT_EQ(tone["nodes"]["write_audio"]["in"]["audio"], "toy_tone.audio");
}

TEST(Examples, AreRefusedWhereTypesDoNotTellHowToWire) {
  Registry registry = all_nodes();
  registry.add<Secrets>();
  registry.add<TellBeside>();
  EXPECT_THROW(example_graph(registry, known_type(registry, "toy.tell_beside")), std::runtime_error);
  Registry bare;
  bare.add<Tone>();
  EXPECT_THROW(example_graph(bare, known_type(bare, "toy.tone")), std::runtime_error);
  EXPECT_THAT(show_node(bare, known_type(bare, "toy.tone")),
              HasSubstr("no example: nothing known gives Transcript, which toy.tone takes as \"word\""));
}

}  // namespace
}  // namespace cli
}  // namespace talkgraph
