#include "graph/description.h"

#include <gtest/gtest.h>

#include "graph/registry.h"

namespace talkgraph {

struct Number {
  double x = 0;
};
void fields(Archive& ar, Number& n) { ar("x", n.x); }
template <>
inline constexpr PortType port_type<Number>{"Number", 1};

namespace {

enum class Sign { plus, minus };

struct Scale {
  double factor = 2;
  Sign sign = Sign::plus;
  Number operator()(const Number& in) const { return {(sign == Sign::plus ? 1 : -1) * factor * in.x}; }
};

}  // namespace

template <>
inline constexpr EnumNames<Sign, 2> enum_names<Sign>{{{Sign::plus, "plus"}, {Sign::minus, "minus"}}};

namespace {

void describe(Description<Scale>& d) {
  d.type("test.scale").summary("multiplies");
  d.input("in").output("out");
  d.param("factor", &Scale::factor).within(0, 10);
  d.param("sign", &Scale::sign);
}

struct Both {
  Number sum;
  std::optional<Number> odd;
};

struct SumAll {
  Both operator()(const Collected<Number>& all, const Number* bias, Random& random) const {
    Both b;
    if (bias) b.sum.x = bias->x;
    for (std::size_t i = 0; i < all.size(); ++i) b.sum.x += all[i].x;
    if (static_cast<int>(b.sum.x) % 2) b.odd = b.sum;
    (void)random;
    return b;
  }
};
void describe(Description<SumAll>& d) {
  d.type("test.sum").summary("adds up");
  d.input("all").input("bias");
  d.output("sum", &Both::sum).output("odd", &Both::odd);
}

struct Count {
  int to = 3;
  Stream<Number> operator()() const {
    std::vector<Item<Number>> items;
    for (int i = 0; i < to; ++i) items.push_back({std::to_string(i), {double(i)}});
    return Stream<Number>(std::move(items));
  }
};
void describe(Description<Count>& d) {
  d.type("test.count").summary("counts");
  d.output("n");
  d.param("to", &Count::to).at_least(0);
}

struct Note {
  Number operator()(const Value& value, const Provenance& made, Context&) const {
    return {static_cast<double>(value.type().type.name.size() + made.node.size())};
  }
};
void describe(Description<Note>& d) {
  d.type("test.note").summary("takes anything").sink();
  d.input("value").output("size");
}

struct Tone {
  double pitch = 440;
  Sign sign = Sign::plus;
};
void parameters(Parameters<Tone>& p) {
  p.param("pitch", &Tone::pitch).positive();
  p.param("sign", &Tone::sign).required();
}

struct Chord {
  std::vector<Tone> tones = {{220, Sign::plus}, {330, Sign::minus}};
  Tone root = {110, Sign::minus};
  std::optional<Tone> bass;
  Number operator()() const { return {}; }
};
void describe(Description<Chord>& d) {
  d.type("test.chord").summary("sounds").output("sound");
  d.param("tones", &Chord::tones);
  d.param("root", &Chord::root);
  d.param("bass", &Chord::bass);
}

LocatedJson json(const std::string& text, Diagnostics& diagnostics) {
  return *parse_json(std::make_shared<SourceText>(SourceText{"test.json", text}), diagnostics);
}

/// Bears a name that is taken.
struct Impostor {
  std::string text;
};
void fields(Archive& ar, Impostor& i) { ar("text", i.text); }

}  // namespace
template <>
inline constexpr PortType port_type<Impostor>{port_type<Number>.name, port_type<Number>.version};
namespace {

struct MakeImpostor {
  Impostor operator()(const Number&) const { return {}; }
};
void describe(Description<MakeImpostor>& d) {
  d.type("test.impostor").summary("gives another type of the same name").input("number").output("number");
}

std::vector<Value> call(const Functor& functor, std::span<const Input> inputs, Context& context) {
  std::vector<Value> outputs;
  Random random;
  functor.call(inputs, context, random, outputs);
  return outputs;
}

TEST(Description, APortTypeIsOneCppType) {
  Registry r;
  r.add<Note>();
  EXPECT_THROW(r.add<MakeImpostor>(), std::logic_error);
}

TEST(Description, GivesAnyValueAndHowItCameAbout) {
  Registry r;
  r.add<Note>();
  const NodeType& type = *r.find("test.note");
  EXPECT_EQ(type.inputs.at(0).type, any_type);
  EXPECT_TRUE(type.uses_provenance);
  EXPECT_EQ(r.port_types(), std::vector<PortType>{port_type<Number>}) << "\"any\" is no type of a graph's input";
  Diagnostics diagnostics;
  const auto node = type.make(nullptr, {}, "node", diagnostics);
  Context context;
  context.provenance.node = "four";
  const std::vector<Input> inputs = {{Value::of(Number{1}), {}}};
  EXPECT_EQ(call(*node, inputs, context).at(0).get<Number>().x, 6 + 4);
}

TEST(Description, CallsAFunctorWithItsParameters) {
  Registry r;
  r.add<Scale>();
  const NodeType* type = r.find("test.scale");
  ASSERT_TRUE(type);
  EXPECT_EQ(type->inputs.at(0).type.name, "Number");
  Diagnostics d;
  const auto params = json(R"({"factor": 3, "sign": "minus"})", d);
  const auto functor = type->make(&params, {}, "node \"s\"", d);
  ASSERT_TRUE(d.ok()) << d.str();
  Context context;
  const Input in{Value::of(Number{5}), {}};
  EXPECT_EQ(call(*functor, {&in, 1}, context).at(0).get<Number>().x, -15);
  EXPECT_EQ(functor->parameters().dump(), R"({"factor":3.0,"sign":"minus"})");
}

TEST(Description, ReportsEveryBadParameterWithItsPlace) {
  Registry r;
  r.add<Scale>();
  Diagnostics d;
  const auto params = json("{\"factor\": 11,\n \"sgn\": 1,\n \"sign\": \"plsu\"}", d);
  r.find("test.scale")->make(&params, {}, "node \"s\"", d);
  ASSERT_EQ(d.messages().size(), 3u) << d.str();
  EXPECT_NE(d.str().find("test.json:1:12: error: node \"s\": parameter \"factor\" must be at most 10, got 11"),
            std::string::npos)
      << d.str();
  EXPECT_NE(d.str().find("test.json:2:2"), std::string::npos);
  EXPECT_NE(d.str().find("did you mean \"sign\"?"), std::string::npos);
  EXPECT_NE(d.str().find("did you mean \"plus\"?"), std::string::npos);
}

TEST(Description, TellsTheMembersOfStructsAndOfListsOfThem) {
  Registry r;
  r.add<Chord>();
  const auto& specs = r.find("test.chord")->parameters;
  for (const auto& spec : specs) {
    ASSERT_EQ(spec.members.size(), 2u) << spec.name;
    EXPECT_EQ(spec.members[0].name, "pitch") << spec.name;
    EXPECT_TRUE(spec.members[1].required) << spec.name;
    EXPECT_EQ(spec.members[1].choices, (std::vector<std::string>{"plus", "minus"})) << spec.name;
  }
  EXPECT_EQ(specs[0].members[0].initial, 440) << "of a tone that a graph adds";
  EXPECT_EQ(specs[1].members[0].initial, 110) << "the node's, which stays where a graph leaves it out";
  EXPECT_EQ(specs[1].members[1].initial, "minus");
  EXPECT_EQ(specs[2].members[0].initial, 440);
}

TEST(Description, CollectsOptionalsAndSeveralOutputs) {
  Registry r;
  r.add<SumAll>();
  const NodeType* type = r.find("test.sum");
  EXPECT_EQ(type->inputs.at(0).kind, PortSpec::Kind::collected);
  EXPECT_EQ(type->inputs.at(1).kind, PortSpec::Kind::optional);
  EXPECT_TRUE(type->uses_random);
  EXPECT_FALSE(type->outputs.at(0).may_drop);
  EXPECT_TRUE(type->outputs.at(1).may_drop);
  Diagnostics d;
  const auto functor = type->make(nullptr, {}, "node", d);
  std::vector<Input> in(2);
  in[0].collected = {{"a", Value::of(Number{1})}, {"b", Value::of(Number{3})}};
  Context context;
  const auto out = call(*functor, in, context);
  EXPECT_EQ(out.at(0).get<Number>().x, 4);
  EXPECT_FALSE(out.at(1));
}

TEST(Description, StreamsItems) {
  Registry r;
  r.add<Count>();
  EXPECT_TRUE(r.find("test.count")->makes_stream);
  Diagnostics d;
  const auto functor = r.find("test.count")->make(nullptr, {}, "node", d);
  Context context;
  Random random;
  auto stream = functor->stream({}, context, random);
  double sum = 0;
  while (auto item = stream.next()) sum += item->value.at(0).get<Number>().x;
  EXPECT_EQ(sum, 3);
}

TEST(Registry, RefusesDuplicates) {
  Registry r;
  r.add<Scale>();
  EXPECT_THROW(r.add<Scale>(), std::logic_error);
}

}  // namespace
}  // namespace talkgraph
