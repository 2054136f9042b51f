#pragma once

#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

#include "graph/node_type.h"

namespace talkgraph {
namespace detail {

template <class T>
struct Signature;  // of a call operator
template <class N, class R, class... A>
struct Signature<R (N::*)(A...) const> {
  using Result = R;
  using Arguments = std::tuple<A...>;
};
template <class N, class R, class... A>
struct Signature<R (N::*)(A...) const noexcept> : Signature<R (N::*)(A...) const> {};

template <class T>
struct is_collected : std::false_type {};
template <class T>
struct is_collected<Collected<T>> : std::true_type {
  using Element = T;
};
template <class T>
struct is_stream : std::false_type {
  using Element = T;
};
template <class T>
struct is_stream<Stream<T>> : std::true_type {
  using Element = T;
};

template <class T>
struct unwrap_optional {
  using type = T;
};
template <class T>
struct unwrap_optional<std::optional<T>> {
  using type = T;
};

/// One argument of a call operator: what it takes from the inputs.
template <class A>
struct Argument {
  static_assert(
      std::is_lvalue_reference_v<A> && std::is_const_v<std::remove_reference_t<A>>,
      "a node takes its inputs as const A&, const Collected<A>&, const A*, and may take Random& and Context&");
  using T = std::remove_cvref_t<A>;
  static constexpr bool is_port = true;
  static PortSpec spec() {
    PortSpec p;
    if constexpr (is_collected<T>::value) {
      static_assert(Port<typename is_collected<T>::Element>, "specialise port_type for what is collected");
      p.type = port_type<typename is_collected<T>::Element>;
      p.kind = PortSpec::Kind::collected;
    } else {
      static_assert(Port<T>, "specialise port_type for the type of this input");
      p.type = port_type<T>;
    }
    return p;
  }
  /// Owns what the argument refers to while the operator runs.
  static auto take(const Input& in) {
    if constexpr (is_collected<T>::value) {
      T all;
      for (const auto& item : in.collected)
        all.add(item.key, item.value.template share<typename is_collected<T>::Element>());
      return all;
    } else {
      return in.value.template share<T>();
    }
  }
  template <class Held>
  static const T& give(const Held& held) {
    if constexpr (is_collected<T>::value)
      return held;
    else
      return *held;
  }
};

template <class T>
struct Argument<const T*> {
  static_assert(Port<T>, "specialise port_type for the type of this input");
  static constexpr bool is_port = true;
  static PortSpec spec() {
    PortSpec p;
    p.type = port_type<T>;
    p.kind = PortSpec::Kind::optional;
    return p;
  }
  static std::shared_ptr<const T> take(const Input& in) { return in.value ? in.value.share<T>() : nullptr; }
  static const T* give(const std::shared_ptr<const T>& held) { return held.get(); }
};

template <>
struct Argument<Context&> {
  static constexpr bool is_port = false;
};
template <>
struct Argument<Random&> {
  static constexpr bool is_port = false;
};

template <class Arguments>
inline constexpr std::size_t port_count = 0;
template <class... A>
inline constexpr std::size_t port_count<std::tuple<A...>> = (std::size_t{Argument<A>::is_port} + ... + 0);

/// Calls `node` with its arguments taken from the inputs in order.
template <class N, class... A>
decltype(auto) invoke(const N& node, std::tuple<A...>*, std::span<const Input> inputs, Context& context,
                      Random& random) {
  std::size_t next = 0;
  const auto hold = [&]<class X>(std::type_identity<X>) {
    if constexpr (Argument<X>::is_port)
      return Argument<X>::take(inputs[next++]);
    else
      return 0;
  };
  const std::tuple<decltype(hold(std::type_identity<A>{}))...> held{hold(std::type_identity<A>{})...};
  const auto give = [&]<class X, class Held>(std::type_identity<X>, const Held& h) -> X {
    if constexpr (std::is_same_v<X, Context&>)
      return context;
    else if constexpr (std::is_same_v<X, Random&>)
      return random;
    else
      return Argument<X>::give(h);
  };
  return [&]<std::size_t... I>(std::index_sequence<I...>)->decltype(auto) {
    return node(give(std::type_identity<A>{}, std::get<I>(held))...);
  }
  (std::index_sequence_for<A...>{});
}

template <class T>
Value to_value(T value) {
  return Value::of(std::move(value));
}
template <class T>
Value to_value(std::optional<T> value) {
  return value ? Value::of(std::move(*value)) : Value();
}

}  // namespace detail

/// The one place that names a node: its ports, parameters, documentation and
/// version. A node offers `void describe(Description<Node>&)`.
template <class N>
class Description {
  using Call = detail::Signature<decltype(&N::operator())>;
  using Result = typename Call::Result;
  using Arguments = typename Call::Arguments;
  static constexpr bool makes_stream = detail::is_stream<Result>::value;
  using Produced = typename detail::unwrap_optional<typename detail::is_stream<Result>::Element>::type;

 public:
  /// "family.name"
  Description& type(std::string name) { return type_.name = std::move(name), *this; }
  /// Raised when the node's results change.
  Description& version(int v) { return type_.version = v, *this; }
  Description& summary(std::string text) { return type_.summary = std::move(text), *this; }
  /// Where the method stands: "Thesis §3.2, Eqn 3.22".
  Description& source(std::string text) { return type_.source = std::move(text), *this; }
  /// Its results are worth keeping on disk: tracking, training, alignment.
  Description& stored() { return type_.stored = true, *this; }
  /// It runs for its effect (a file written), even if nothing reads its outputs.
  Description& sink() { return type_.sink = true, *this; }

  /// Names the next input port, in the order of the call operator's arguments.
  Description& input(std::string name, std::string doc = "") {
    PortSpec spec = input_spec(type_.inputs.size(), std::make_index_sequence<std::tuple_size_v<Arguments>>{});
    spec.name = std::move(name);
    spec.doc = std::move(doc);
    type_.inputs.push_back(std::move(spec));
    return *this;
  }
  /// Names the one output.
  Description& output(std::string name, std::string doc = "") {
    static_assert(Port<Produced>, "name the members of a returned struct: output(\"name\", &Out::member)");
    add_output<Produced>(std::move(name), std::move(doc), detail::unwrap_optional<Result>{});
    type_.outputs.back().may_drop = !std::is_same_v<typename detail::is_stream<Result>::Element, Produced>;
    getters_.push_back([](Produced& all) { return Value::of(std::move(all)); });
    return *this;
  }
  /// Names one member of the returned struct as an output.
  template <class M>
  Description& output(std::string name, M Produced::*member, std::string doc = "") {
    using T = typename detail::unwrap_optional<M>::type;
    static_assert(Port<T>, "specialise port_type for the type of this output");
    PortSpec spec;
    spec.name = std::move(name);
    spec.doc = std::move(doc);
    spec.type = port_type<T>;
    spec.may_drop = !std::is_same_v<T, M> || !std::is_same_v<typename detail::is_stream<Result>::Element, Produced>;
    type_.outputs.push_back(std::move(spec));
    getters_.push_back([member](Produced& all) { return detail::to_value(std::move(all.*member)); });
    return *this;
  }
  template <class M>
  ParameterHandle param(std::string name, M N::*member) {
    return parameters_.param(std::move(name), member);
  }

  /// The finished type. Throws std::logic_error if the description is incomplete.
  NodeType finish() &&;

 private:
  using Getter = std::function<Value(Produced&)>;

  template <class T, class Tag>
  void add_output(std::string name, std::string doc, Tag) {
    PortSpec spec;
    spec.name = std::move(name);
    spec.doc = std::move(doc);
    spec.type = port_type<T>;
    type_.outputs.push_back(std::move(spec));
  }

  template <std::size_t... I>
  PortSpec input_spec(std::size_t wanted, std::index_sequence<I...>) {
    PortSpec found;
    std::size_t port = 0;
    bool ok = false;
    const auto look = [&]<class A>(std::type_identity<A>) {
      if constexpr (detail::Argument<A>::is_port)
        if (port++ == wanted) found = detail::Argument<A>::spec(), ok = true;
    };
    (look(std::type_identity<std::tuple_element_t<I, Arguments>>{}), ...);
    if (!ok) throw std::logic_error(type_.name + ": more inputs described than the call operator takes");
    return found;
  }

  class Bound final : public Functor {
   public:
    Bound(N node, std::vector<Getter> getters, std::shared_ptr<const std::vector<ParameterSpec>> specs)
        : node_(std::move(node)), getters_(std::move(getters)), specs_(std::move(specs)) {}

    std::vector<Value> call(std::span<const Input> inputs, Context& context, Random& random) const override {
      if constexpr (makes_stream) {
        throw std::logic_error("a stream source is not called");
      } else {
        auto result = detail::invoke(node_, static_cast<Arguments*>(nullptr), inputs, context, random);
        return values(std::move(result));
      }
    }
    AnyStream stream(std::span<const Input> inputs, Context& context, Random& random) const override {
      if constexpr (makes_stream) {
        auto result =
            std::make_shared<Result>(detail::invoke(node_, static_cast<Arguments*>(nullptr), inputs, context, random));
        const auto size = result->size();
        // The inputs outlive the stream: what it produces may refer to them.
        auto held = std::make_shared<std::vector<Input>>(inputs.begin(), inputs.end());
        return AnyStream(
            [this, result, held]() -> std::optional<Item<std::vector<Value>>> {
              auto item = result->next();
              if (!item) return {};
              return Item<std::vector<Value>>{std::move(item->key), values(std::move(item->value))};
            },
            size);
      } else {
        throw std::logic_error("not a stream source");
      }
    }
    Json parameters() const override { return detail::write_struct(&node_, *specs_); }

   private:
    template <class T>
    std::vector<Value> values(T result) const {
      std::vector<Value> out(getters_.size());
      if constexpr (std::is_same_v<T, Produced>) {
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = getters_[i](result);
      } else if (result) {
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = getters_[i](*result);
      }
      return out;
    }

    N node_;
    std::vector<Getter> getters_;
    std::shared_ptr<const std::vector<ParameterSpec>> specs_;
  };

  NodeType type_;
  Parameters<N> parameters_;
  std::vector<Getter> getters_;
};

template <class N>
NodeType Description<N>::finish() && {
  if (type_.name.empty() || type_.summary.empty()) throw std::logic_error("a node description without type or summary");
  if (type_.inputs.size() != detail::port_count<Arguments>)
    throw std::logic_error(type_.name + ": fewer inputs described than the call operator takes");
  if (type_.outputs.empty()) throw std::logic_error(type_.name + ": no output described");
  type_.makes_stream = makes_stream;
  type_.uses_random = []<class... A>(std::tuple<A...>*) {
    return (std::is_same_v<A, Random&> || ...);
  }(static_cast<Arguments*>(nullptr));
  type_.parameters = parameters_.specs();
  auto specs = std::make_shared<const std::vector<ParameterSpec>>(type_.parameters);
  type_.make = [specs, getters = getters_](const LocatedJson* params, const Place& place, const std::string& subject,
                                           Diagnostics& diagnostics) -> std::unique_ptr<Functor> {
    N node{};
    LocatedJson none;
    none.kind = LocatedJson::Kind::object;
    none.place = place;
    detail::read_struct(params ? *params : none, &node, *specs, subject, diagnostics);
    return std::make_unique<Bound>(std::move(node), getters, specs);
  };
  return std::move(type_);
}

}  // namespace talkgraph
