#pragma once

#include "graph/registry.h"

namespace talkgraph::toy {

struct Number {
  double x = 0;
};
inline void fields(Archive& ar, Number& n) { ar("x", n.x); }
struct Word {
  std::string w;
};
inline void fields(Archive& ar, Word& n) { ar("w", n.w); }

struct Count {
  int to = 3;
  Stream<Number> operator()() const {
    std::vector<Item<Number>> items;
    for (int i = 0; i < to; ++i) items.push_back({std::to_string(i), {double(i)}});
    return Stream<Number>(std::move(items));
  }
};
struct Constant {
  double x = 1;
  FilePath file;
  GraphText inner;
  Number operator()() const { return {x}; }
};
struct Add {
  double bias = 0;
  Number operator()(const Number& a, const Number* b) const { return {a.x + (b ? b->x : 0) + bias}; }
};
struct Sum {
  Number operator()(const Collected<Number>& all) const {
    Number sum;
    for (std::size_t i = 0; i < all.size(); ++i) sum.x += all[i].x;
    return sum;
  }
};
struct Note {
  Word operator()(const Value& value, const Provenance& made) const {
    return {made.node + ": " + std::string(value.type().type.name)};
  }
};
struct Spell {
  Word operator()(const Number& n) const { return {std::to_string(n.x)}; }
};

}  // namespace talkgraph::toy

namespace talkgraph {

template <>
inline constexpr PortType port_type<toy::Number>{"Number", 1};
template <>
inline constexpr PortType port_type<toy::Word>{"Word", 1};

}  // namespace talkgraph

namespace talkgraph::toy {

inline void describe(Description<Count>& d) {
  d.type("toy.count").summary("counts from 0");
  d.output("n");
  d.param("to", &Count::to).at_least(0);
}
inline void describe(Description<Constant>& d) {
  d.type("toy.constant").summary("one number");
  d.output("n");
  d.param("x", &Constant::x).within(-100, 100);
  d.param("file", &Constant::file);
  d.param("inner", &Constant::inner);
}
inline void describe(Description<Add>& d) {
  d.type("toy.add").summary("adds");
  d.input("a").input("b").output("sum");
  d.param("bias", &Add::bias);
}
inline void describe(Description<Sum>& d) {
  d.type("toy.sum").summary("adds up a stream");
  d.input("all").output("sum");
}
inline void describe(Description<Note>& d) {
  d.type("toy.note").summary("takes anything").sink();
  d.input("value").output("what");
}
inline void describe(Description<Spell>& d) {
  d.type("toy.spell").summary("writes a number");
  d.input("n").output("word");
}

inline Registry registry() {
  Registry r;
  r.add<Count>();
  r.add<Constant>();
  r.add<Add>();
  r.add<Sum>();
  r.add<Note>();
  r.add<Spell>();
  return r;
}

}  // namespace talkgraph::toy
