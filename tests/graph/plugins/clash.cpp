#include "graph/plugin.h"

namespace {

/// Has the name of the program's type, but is another one.
struct Number {
  std::string digits;
};
void fields(talkgraph::Archive& ar, Number& n) { ar("digits", n.digits); }

}  // namespace

template <>
inline constexpr talkgraph::PortType talkgraph::port_type<Number>{"Number", 1};

namespace {

struct Digits {
  Number operator()() const { return {"42"}; }
};
void describe(talkgraph::Description<Digits>& d) { d.type("clash.digits").summary("42").output("number"); }

}  // namespace

TALKGRAPH_PLUGIN([](talkgraph::Registry& registry) { registry.add<Digits>(); })
