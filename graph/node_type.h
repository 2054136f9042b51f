#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <typeinfo>
#include <vector>

#include "graph/context.h"
#include "graph/parameter.h"
#include "graph/random.h"
#include "graph/value.h"

namespace talkgraph {

/// What arrives at an input port.
struct Input {
  Value value;                         ///< of an item port; empty where an optional input has nothing
  std::vector<Item<Value>> collected;  ///< of a collecting port
};

/// A stream of tuples: for each item, one value a port.
using AnyStream = Stream<std::vector<Value>>;

/// A node at work: its functor with the parameters set. Calls are const and may
/// run at the same time.
class Functor {
 public:
  virtual ~Functor() = default;
  /// Fills `outputs` with one value an output port, empty where the node drops the item. Not for sources.
  virtual void call(std::span<const Input> inputs, Context& context, Random& random,
                    std::vector<Value>& outputs) const = 0;
  /// Only for types with `makes_stream`.
  virtual AnyStream stream(std::span<const Input> inputs, Context& context, Random& random) const = 0;
  virtual Json parameters() const = 0;
};

struct PortSpec {
  enum class Kind { item, optional, collected };
  std::string name;
  std::string doc;
  PortType type;
  Kind kind = Kind::item;               ///< of an input
  bool may_drop = false;                ///< of an output
  const TypeInfo* info = nullptr;       ///< of an output: how its values are loaded
  const std::type_info* cpp = nullptr;  ///< the C++ type; none for any_type
};

/// All that is known of a node type: made from its description.
struct NodeType {
  std::string name;  ///< "speech.mfcc"
  int version = 1;   ///< raised by its author when its results change
  std::string summary;
  std::string source;  ///< section or equation of the thesis, or a citation
  std::vector<PortSpec> inputs;
  std::vector<PortSpec> outputs;
  std::vector<ParameterSpec> parameters;
  bool makes_stream = false;
  bool uses_random = false;
  bool uses_context = false;
  bool uses_provenance = false;  ///< what it writes says how it came about
  bool stored = false;           ///< its results are worth keeping on disk
  bool sink = false;             ///< runs for its effect, even if nothing reads its outputs
  /// Complaints name the node as `subject` ("node \"mfcc\"").
  std::function<std::unique_ptr<Functor>(const LocatedJson* params, const Place& place, const std::string& subject,
                                         Diagnostics&)>
      make;
};

}  // namespace talkgraph
