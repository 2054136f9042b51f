#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <random>
#include <string>
#include <thread>

#include "graph/output_file.h"
#include "graph/registry.h"

namespace talkgraph {

/// 64 bits that remember all that went into them, and the order.
struct Mark {
  std::uint64_t bits = 0;
};
inline void fields(Archive& ar, Mark& m) { ar("bits", m.bits); }
template <>
inline constexpr PortType port_type<Mark>{"Mark", 1};

namespace toy {

/// Microseconds that each call may dawdle at most.
inline std::atomic<int> dawdle_at_most{0};

inline void dawdle() {
  if (const int most = dawdle_at_most) {
    thread_local std::minstd_rand generator(std::random_device{}());
    std::this_thread::sleep_for(std::chrono::microseconds(generator() % static_cast<unsigned>(most)));
  }
}

inline std::uint64_t mix(std::uint64_t h, std::uint64_t x) {
  h = (h ^ x) * 0x9e3779b97f4a7c15ull;
  return h ^ (h >> 29);
}
inline std::uint64_t mix(std::uint64_t h, const std::string& text) {
  for (const char c : text) h = mix(h, static_cast<unsigned char>(c));
  return h;
}
inline std::uint64_t mix(std::uint64_t h, const Collected<Mark>& all) {
  for (std::size_t i = 0; i < all.size(); ++i) h = mix(mix(h, all.key(i)), all[i].bits);
  return mix(h, all.size());
}

struct Made {
  Mark all;
  std::optional<Mark> some;
};

inline Stream<Made> make_stream(int to, std::string prefix, std::uint64_t start, Random* random) {
  return Stream<Made>(
      [=, i = 0]() mutable -> std::optional<Item<Made>> {
        if (i == to) return {};
        dawdle();
        Made made;
        made.all.bits = mix(start, static_cast<std::uint64_t>(i)) ^ (random ? random->bits() : 0);
        if (made.all.bits % 3) made.some = Mark{made.all.bits + 1};
        return Item<Made>{prefix + std::to_string(i++), made};
      },
      static_cast<std::size_t>(to));
}

struct Source {
  int to = 10;
  Stream<Made> operator()(Random& random) const { return make_stream(to, "u", 1, &random); }
};
inline void describe(Description<Source>& d) {
  d.type("toy.source").summary("items u0, u1, ...").output("all", &Made::all).output("some", &Made::some);
  d.param("to", &Source::to).at_least(0);
}

/// As the states of a model that was trained from a stream.
struct States {
  Stream<Made> operator()(const Collected<Mark>& all, const Mark* seed, Random& random) const {
    const auto h = mix(seed ? seed->bits : 7, all);
    return make_stream(static_cast<int>(h % 6), "s", h, &random);
  }
};
inline void describe(Description<States>& d) {
  d.type("toy.states").summary("a few items made from a collected stream").input("all").input("seed");
  d.output("all", &Made::all).output("some", &Made::some);
}

struct FromOne {
  Stream<Made> operator()(const Mark& one) const {
    return make_stream(static_cast<int>(one.bits % 8), "o", one.bits, {});
  }
};
inline void describe(Description<FromOne>& d) {
  d.type("toy.from_one").summary("items made from a single value").input("one");
  d.output("all", &Made::all).output("some", &Made::some);
}

struct Map {
  std::uint64_t k = 1;
  Mark operator()(const Mark& in, Random& random) const {
    dawdle();
    return {mix(in.bits, k) ^ random.bits()};
  }
};
inline void describe(Description<Map>& d) {
  d.type("toy.map").summary("changes an item").input("in").output("out");
  d.param("k", &Map::k);
}

struct Drop {
  std::optional<Mark> operator()(const Mark& in) const {
    dawdle();
    if (in.bits % 4 == 0) return {};
    return Mark{mix(in.bits, 5)};
  }
};
inline void describe(Description<Drop>& d) { d.type("toy.drop").summary("drops some items").input("in").output("out"); }

struct Join {
  Made operator()(const Mark& a, const Mark& b, const Mark* c) const {
    dawdle();
    Made made{{mix(mix(a.bits, b.bits), c ? c->bits : 3)}, {}};
    if (made.all.bits % 3) made.some = made.all;
    return made;
  }
};
inline void describe(Description<Join>& d) {
  d.type("toy.join").summary("joins two, perhaps three").input("a").input("b").input("c");
  d.output("all", &Made::all).output("some", &Made::some);
}

struct Train {
  Mark operator()(const Collected<Mark>& all, const Mark* start) const {
    dawdle();
    return {mix(start ? start->bits : 11, all)};
  }
};
inline void describe(Description<Train>& d) {
  d.type("toy.train").summary("collects a stream").input("all").input("start").output("model");
}

struct MaybeTrain {
  std::optional<Mark> operator()(const Collected<Mark>& all) const {
    const auto h = mix(2, all);
    if (h % 5 == 0) return {};
    return Mark{h};
  }
};
inline void describe(Description<MaybeTrain>& d) {
  d.type("toy.maybe_train").summary("collects, may give nothing").input("all").output("model");
}

struct Apply {
  Mark operator()(const Mark& model, const Collected<Mark>& all, const Mark& item) const {
    dawdle();
    return {mix(mix(model.bits, all), item.bits)};
  }
};
inline void describe(Description<Apply>& d) {
  d.type("toy.apply").summary("a model, a stream and an item").input("model").input("all").input("item").output("out");
}

struct Constant {
  std::uint64_t bits = 1;
  Mark operator()() const { return {bits}; }
};
inline void describe(Description<Constant>& d) {
  d.type("toy.constant").summary("one mark").output("out");
  d.param("bits", &Constant::bits);
}

struct FailAt {
  std::string key;
  Mark operator()(const Mark& in, Context& context) const {
    dawdle();
    context.log("looking");
    if (context.item == key) throw std::runtime_error("the picture is black");
    return in;
  }
};
inline void describe(Description<FailAt>& d) {
  d.type("toy.fail_at").summary("fails at one item").input("in").output("out");
  d.param("key", &FailAt::key);
}

struct Twice {
  Stream<Mark> operator()() const { return Stream<Mark>({{"a", {1}}, {"b", {2}}, {"a", {3}}, {"c", {4}}}); }
};
inline void describe(Description<Twice>& d) { d.type("toy.twice").summary("gives a key twice").output("out"); }

struct BreakOff {
  Stream<Mark> operator()() const {
    return Stream<Mark>([i = 0]() mutable -> std::optional<Item<Mark>> {
      if (i == 3) throw std::runtime_error("the disk is gone");
      return Item<Mark>{"u" + std::to_string(i++), {1}};
    });
  }
};
inline void describe(Description<BreakOff>& d) { d.type("toy.break_off").summary("fails after u2").output("out"); }

/// Gives u0 to u4 but for u1.
struct Gap {
  Stream<Mark> operator()() const {
    return Stream<Mark>(
        [i = 0]() mutable -> std::optional<Item<Mark>> {
          if (i == 5) return {};
          const int n = i++;
          if (n == 1) throw std::runtime_error("u1 is damaged");
          return Item<Mark>{"u" + std::to_string(n), {1}};
        },
        5);
  }
};
inline void describe(Description<Gap>& d) { d.type("toy.gap").summary("fails at u1 of 5").output("out"); }

/// Works until it is told to stop.
struct Endless {
  Mark operator()(const Mark& in, Context& context) const {
    for (;;) {
      context.check_cancelled();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return in;
  }
};
inline void describe(Description<Endless>& d) { d.type("toy.endless").summary("never ends").input("in").output("out"); }

struct Write {
  std::string folder = "out";
  Mark operator()(const Mark& in, Context& context) const {
    write_file(context.file(folder + "/" + context.item + ".txt"), std::to_string(in.bits));
    return in;
  }
};
inline void describe(Description<Write>& d) {
  d.type("toy.write").summary("writes a file an item").sink().input("in").output("out");
  d.param("folder", &Write::folder);
}

inline Registry registry() {
  Registry r;
  r.add<Source>();
  r.add<States>();
  r.add<FromOne>();
  r.add<Map>();
  r.add<Drop>();
  r.add<Join>();
  r.add<Train>();
  r.add<MaybeTrain>();
  r.add<Apply>();
  r.add<Constant>();
  r.add<FailAt>();
  r.add<Twice>();
  r.add<BreakOff>();
  r.add<Gap>();
  r.add<Endless>();
  r.add<Write>();
  return r;
}

}  // namespace toy
}  // namespace talkgraph
