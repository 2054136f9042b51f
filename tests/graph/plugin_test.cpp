#include "graph/plugin.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/graph/toy_nodes.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using toy::Number;

std::string plugin(const std::string& name) { return PLUGINS + name + ".so"; }

/// Why a file is refused; empty if it is not.
std::string refusal(const std::string& file) {
  Registry registry;
  registry.add<toy::Constant>();
  try {
    load_plugin(file, registry);
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), HasSubstr(file));
    return e.what();
  }
  return "";
}

TEST(Plugin, BringsNodesThatTakeAndGiveValuesOfTheProgram) {
  Registry registry;
  load_plugin(plugin("good"), registry);
  const NodeType* type = registry.find("good.halve");
  ASSERT_NE(type, nullptr);
  Diagnostics diagnostics;
  const auto functor = type->make(nullptr, {}, "node", diagnostics);
  Context context;
  Random random;
  const auto call = [&](double x) {
    const std::vector<Input> in{{Value::of(Number{x}), {}}};
    std::vector<Value> outputs;
    functor->call(in, context, random, outputs);
    return outputs.at(0);
  };
  const Value half = call(3);
  EXPECT_EQ(half.get<Number>().x, 1.5);
  EXPECT_EQ(&half.type(), &type_info<Number>()) << "what is known of a type is there once";
  EXPECT_THROW(call(-1), Cancelled);
}

TEST(Plugin, IsAddedOnce) {
  Registry registry;
  load_plugin(plugin("good"), registry);
  try {
    load_plugin(plugin("good"), registry);
    FAIL() << "a node type that exists";
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("libplugin_good.so"), HasSubstr("two nodes of type good.halve")));
  }
}

TEST(Plugin, ThatCannotBeUsedIsRefusedWithTheReason) {
  EXPECT_THAT(refusal("nowhere.so"), HasSubstr("there is no such file"));
  const test::TemporaryFolder folder;
  EXPECT_THAT(refusal(folder.write("text.so", "no library")),
              AllOf(HasSubstr("cannot be loaded"), HasSubstr("must be a shared library")));
  EXPECT_THAT(refusal(folder.path().string()), HasSubstr("cannot be loaded"));
  EXPECT_THAT(refusal(plugin("unresolved")), AllOf(HasSubstr("undefined symbol"), HasSubstr("against this talkgraph")));
  EXPECT_THAT(refusal(plugin("no_entry")), HasSubstr("TALKGRAPH_PLUGIN"));
  EXPECT_THAT(refusal(plugin("other_version")), AllOf(HasSubstr("talkgraph 0.0.1"), HasSubstr(TALKGRAPH_PLUGIN_VERSION),
                                                      HasSubstr("build the plugin again")));
  EXPECT_THAT(refusal(plugin("clash")), HasSubstr("the port type Number is two C++ types"));
  EXPECT_THAT(refusal(plugin("throws")), HasSubstr("cannot be registered: no licence today"));
  EXPECT_THAT(refusal(plugin("throws_a_number")), HasSubstr("cannot be registered"));
}

}  // namespace
}  // namespace talkgraph
