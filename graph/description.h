#pragma once

#include <array>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <typeinfo>
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
template <class N>
concept HasSignature = requires {
  typename Signature<decltype(&N::operator())>::Result;
};

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

/// What a call operator takes from one input port.
struct PortKind {
  PortType type;
  PortSpec::Kind kind = PortSpec::Kind::item;
  const std::type_info* cpp = nullptr;
};
template <class T>
constexpr PortKind port_kind(PortSpec::Kind kind) {
  return {port_type<T>, kind, &typeid(T)};
}

/// One argument of a call operator: what it takes from the inputs.
template <class A>
struct Argument {
  static_assert(std::is_lvalue_reference_v<A> && std::is_const_v<std::remove_reference_t<A>>,
                "a node takes its inputs as const A&, const Collected<A>&, const A*, const Value&, and may take "
                "Random&, Context& and const Provenance&");
  using T = std::remove_cvref_t<A>;
  static constexpr bool is_port = true;
  static constexpr PortKind port() {
    if constexpr (is_collected<T>::value) {
      static_assert(Port<typename is_collected<T>::Element>, "specialise port_type for what is collected");
      return port_kind<typename is_collected<T>::Element>(PortSpec::Kind::collected);
    } else {
      static_assert(Port<T>, "specialise port_type for the type of this input");
      return port_kind<T>(PortSpec::Kind::item);
    }
  }
  /// What the argument refers to; the inputs outlive the call.
  static auto take(const Input& in) {
    if constexpr (is_collected<T>::value) {
      T all;
      for (const auto& item : in.collected)
        all.add(item.key, item.value.template share<typename is_collected<T>::Element>());
      return all;
    } else {
      return &in.value.template get<T>();
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
  static constexpr PortKind port() { return port_kind<T>(PortSpec::Kind::optional); }
  static const T* take(const Input& in) { return in.value ? &in.value.get<T>() : nullptr; }
  static const T* give(const T* held) { return held; }
};

template <>
struct Argument<const Value&> {
  static constexpr bool is_port = true;
  static constexpr PortKind port() { return {any_type}; }
  static const Value* take(const Input& in) { return &in.value; }
  static const Value& give(const Value* held) { return *held; }
};

template <>
struct Argument<const Provenance&> {
  static constexpr bool is_port = false;
};
template <>
struct Argument<Context&> {
  static constexpr bool is_port = false;
};
template <>
struct Argument<Random&> {
  static constexpr bool is_port = false;
};

/// What a call operator takes from its input ports, in their order.
template <class Arguments>
struct Ports;
template <class... A>
struct Ports<std::tuple<A...>> {
  static constexpr auto kinds = [] {
    std::array<PortKind, (std::size_t{Argument<A>::is_port} + ... + 0)> all;
    [[maybe_unused]] std::size_t next = 0;
    [[maybe_unused]] const auto add = [&]<class X>(std::type_identity<X>) {
      if constexpr (Argument<X>::is_port) all[next++] = Argument<X>::port();
    };
    (add(std::type_identity<A>{}), ...);
    return all;
  }();
  static constexpr bool use_random = (std::is_same_v<A, Random&> || ...);
  static constexpr bool use_context = (std::is_same_v<A, Context&> || ...);
  static constexpr bool use_provenance = (std::is_same_v<A, const Provenance&> || ...);
};

/// Throws std::logic_error if the call operator takes no further input.
void add_input(NodeType& type, std::span<const PortKind> kinds, std::string name, std::string doc);
void add_output(NodeType& type, PortSpec spec);
/// Throws std::logic_error if something is not described.
void check_described(const NodeType& type, std::size_t inputs);
/// `params` is null where a graph gives none.
void read_parameters(const LocatedJson* params, const Place& place, void* node, const std::vector<ParameterSpec>& specs,
                     const std::string& subject, Diagnostics& diagnostics);

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
    else if constexpr (std::is_same_v<X, const Provenance&>)
      return context.provenance;
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
  static_assert(std::is_default_constructible_v<N>, "a node is a struct that can be made without arguments");
  static_assert(detail::HasSignature<N>,
                "a node has one call operator, which is const and neither overloaded nor a template");
  using Call = detail::Signature<decltype(&N::operator())>;
  using Result = typename Call::Result;
  using Arguments = typename Call::Arguments;
  using Ports = detail::Ports<Arguments>;
  static constexpr bool makes_stream = detail::is_stream<Result>::value;
  using Made = typename detail::is_stream<Result>::Element;
  using Produced = typename detail::unwrap_optional<Made>::type;
  static constexpr bool drops_items = !std::is_same_v<Made, Produced>;

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
  Description& input(const std::string& name, const std::string& doc = "") {
    detail::add_input(type_, Ports::kinds, name, doc);
    return *this;
  }
  /// Names the one output.
  Description& output(std::string name, std::string doc = "") {
    static_assert(Port<Produced>, "name the members of a returned struct: output(\"name\", &Out::member)");
    return add_output(std::move(name), std::move(doc), type_info<Produced>(), typeid(Produced), drops_items,
                      [](Produced& all, Value& to) { to = Value::of(std::move(all)); });
  }
  /// Names one member of the returned struct as an output.
  template <class M>
  Description& output(std::string name, M Produced::*member, std::string doc = "") {
    using T = typename detail::unwrap_optional<M>::type;
    static_assert(Port<T>, "specialise port_type for the type of this output");
    return add_output(std::move(name), std::move(doc), type_info<T>(), typeid(T), drops_items || !std::is_same_v<T, M>,
                      [member](Produced& all, Value& to) { to = detail::to_value(std::move(all.*member)); });
  }
  template <class M>
  ParameterHandle param(std::string name, M N::*member) {
    return parameters_.param(std::move(name), member);
  }

  /// The finished type. Throws std::logic_error if the description is incomplete.
  NodeType finish() &&;

 private:
  using Getter = std::function<void(Produced&, Value&)>;

  Description& add_output(std::string name, std::string doc, const TypeInfo& info, const std::type_info& cpp,
                          bool may_drop, Getter get) {
    detail::add_output(type_,
                       {std::move(name), std::move(doc), info.type, PortSpec::Kind::item, may_drop, &info, &cpp});
    getters_.push_back(std::move(get));
    return *this;
  }

  class Bound final : public Functor {
   public:
    Bound(N node, std::vector<Getter> getters, std::shared_ptr<const std::vector<ParameterSpec>> specs)
        : node_(std::move(node)), getters_(std::move(getters)), specs_(std::move(specs)) {}

    void call(std::span<const Input> inputs, Context& context, Random& random,
              std::vector<Value>& outputs) const override {
      if constexpr (makes_stream)
        throw std::logic_error("a stream source is not called");
      else
        put(detail::invoke(node_, static_cast<Arguments*>(nullptr), inputs, context, random), outputs);
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
              Item<std::vector<Value>> made{std::move(item->key), {}};
              put(std::move(item->value), made.value);
              return made;
            },
            size);
      } else {
        throw std::logic_error("not a stream source");
      }
    }
    Json parameters() const override { return detail::write_struct(&node_, *specs_); }

   private:
    template <class T>
    void put(T result, std::vector<Value>& outputs) const {
      outputs.clear();
      outputs.resize(getters_.size());
      if constexpr (std::is_same_v<T, Produced>) {
        for (std::size_t i = 0; i < outputs.size(); ++i) getters_[i](result, outputs[i]);
      } else if (result) {
        for (std::size_t i = 0; i < outputs.size(); ++i) getters_[i](*result, outputs[i]);
      }
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
  detail::check_described(type_, Ports::kinds.size());
  type_.makes_stream = makes_stream;
  type_.uses_random = Ports::use_random;
  type_.uses_context = Ports::use_context;
  type_.uses_provenance = Ports::use_provenance;
  type_.parameters = parameters_.specs();
  auto specs = std::make_shared<const std::vector<ParameterSpec>>(type_.parameters);
  type_.make = [specs, getters = getters_](const LocatedJson* params, const Place& place, const std::string& subject,
                                           Diagnostics& diagnostics) -> std::unique_ptr<Functor> {
    N node{};
    detail::read_parameters(params, place, &node, *specs, subject, diagnostics);
    return std::make_unique<Bound>(std::move(node), getters, specs);
  };
  return std::move(type_);
}

}  // namespace talkgraph
