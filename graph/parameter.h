#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "graph/json.h"
#include "graph/rational.h"

namespace talkgraph {

/// A file or folder named in a graph. A relative name is taken from the folder
/// of the file that the graph's value stands in, or from the working directory
/// for --set.
struct FilePath {
  std::string path;
  bool operator==(const FilePath&) const = default;
};

/// A graph file given to a node whole: resolved and self-contained, as JSON.
struct GraphText {
  std::string json;
  bool operator==(const GraphText&) const = default;
};

/// Named values of an enum parameter, specialised beside the enum:
///   template <> inline constexpr EnumNames<Window, 2> enum_names<Window>{{{Window::hamming, "hamming"}, ...}};
template <class E, std::size_t N>
struct EnumNames {
  struct Entry {
    E value;
    std::string_view name;
  };
  Entry entries[N];
};
template <class E>
inline constexpr EnumNames<E, 0> enum_names{};

/// Limits of a number parameter, of each element for a vector.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;
};

/// How one parameter of a node is read, checked, documented and written back.
struct ParameterSpec {
  std::string name;
  std::string type;  ///< "number", "integer", "text", "ratio", "list of number" ...
  std::string doc;
  std::string unit;
  Json initial;  ///< default value
  bool required = false;
  Range range;
  std::vector<std::string> choices;    ///< of an enum
  std::vector<ParameterSpec> members;  ///< of a nested struct, or of each in a list of them
  std::ptrdiff_t offset = 0;           ///< of the parameter in its struct, bytes
  /// Reads the parameter; complaints start with `subject` ("node \"mfcc\": parameter \"filters\"").
  void (*read)(void* parameter, const LocatedJson&, const Range&, const std::string& subject, Diagnostics&) = nullptr;
  Json (*write)(const void* parameter) = nullptr;
};

/// Specialised or offered as `void parameters(Parameters<T>&)` for nested structs.
template <class T>
class Parameters;

namespace detail {

void complain_type(const LocatedJson&, std::string_view expected, const std::string& subject, Diagnostics&);
bool check_range(double value, const Range&, const LocatedJson&, const std::string& subject, Diagnostics&);
bool read_number(const LocatedJson&, double& value, const Range&, const std::string& subject, Diagnostics&);
bool read_integer(const LocatedJson&, std::int64_t& value, const Range&, double type_low, double type_high,
                  const std::string& subject, Diagnostics&);
bool read_text(const LocatedJson&, std::string& value, std::string_view expected, const std::string& subject,
               Diagnostics&);
void read_path(const LocatedJson&, FilePath& value, const std::string& subject, Diagnostics&);
void read_rational(const LocatedJson&, Rational& value, const Range&, const std::string& subject, Diagnostics&);
void complain_choice(const LocatedJson&, const std::string& given, const std::vector<std::string>& choices,
                     const std::string& subject, Diagnostics&);
void read_struct(const LocatedJson&, void* target, const std::vector<ParameterSpec>&, const std::string& subject,
                 Diagnostics&);
Json write_struct(const void* target, const std::vector<ParameterSpec>&);

template <class T>
struct is_std_vector : std::false_type {};
template <class T>
struct is_std_vector<std::vector<T>> : std::true_type {};
template <class T>
struct is_std_optional : std::false_type {};
template <class T>
struct is_std_optional<std::optional<T>> : std::true_type {};

template <class T>
const std::vector<ParameterSpec>& struct_parameters();

template <class T>
std::string parameter_type() {
  if constexpr (std::is_same_v<T, bool>)
    return "boolean";
  else if constexpr (std::is_integral_v<T>)
    return "integer";
  else if constexpr (std::is_floating_point_v<T>)
    return "number";
  else if constexpr (std::is_same_v<T, std::string>)
    return "text";
  else if constexpr (std::is_same_v<T, FilePath>)
    return "path";
  else if constexpr (std::is_same_v<T, GraphText>)
    return "graph";
  else if constexpr (std::is_same_v<T, Rational>)
    return "ratio";
  else if constexpr (std::is_enum_v<T>)
    return "choice";
  else if constexpr (is_std_vector<T>::value)
    return "list of " + parameter_type<typename T::value_type>();
  else if constexpr (is_std_optional<T>::value)
    return parameter_type<typename T::value_type>();
  else
    return "object";
}

template <class T>
std::vector<std::string> parameter_choices() {
  std::vector<std::string> names;
  if constexpr (std::is_enum_v<T>)
    for (const auto& entry : enum_names<T>.entries) names.emplace_back(entry.name);
  else if constexpr (is_std_vector<T>::value || is_std_optional<T>::value)
    return parameter_choices<typename T::value_type>();
  return names;
}

template <class T>
std::vector<ParameterSpec> parameter_members() {
  if constexpr (is_std_vector<T>::value || is_std_optional<T>::value)
    return parameter_members<typename T::value_type>();
  else if constexpr (std::is_class_v<T>)
    if constexpr (requires(Parameters<T> & p) { parameters(p); }) return struct_parameters<T>();
  return {};
}

template <class T>
void read_parameter(const LocatedJson& json, T& value, const Range& range, const std::string& subject,
                    Diagnostics& diagnostics) {
  if constexpr (std::is_same_v<T, bool>) {
    if (json.is(LocatedJson::Kind::boolean))
      value = json.scalar.template get<bool>();
    else
      complain_type(json, "true or false", subject, diagnostics);
  } else if constexpr (std::is_integral_v<T>) {
    std::int64_t v = 0;
    if (read_integer(json, v, range, static_cast<double>(std::numeric_limits<T>::min()),
                     static_cast<double>(std::numeric_limits<T>::max()), subject, diagnostics))
      value = static_cast<T>(v);
  } else if constexpr (std::is_floating_point_v<T>) {
    double v = 0;
    if (read_number(json, v, range, subject, diagnostics)) value = static_cast<T>(v);
  } else if constexpr (std::is_same_v<T, std::string>) {
    read_text(json, value, "text", subject, diagnostics);
  } else if constexpr (std::is_same_v<T, FilePath>) {
    read_path(json, value, subject, diagnostics);
  } else if constexpr (std::is_same_v<T, GraphText>) {
    read_text(json, value.json, "a graph file", subject, diagnostics);
  } else if constexpr (std::is_same_v<T, Rational>) {
    read_rational(json, value, range, subject, diagnostics);
  } else if constexpr (std::is_enum_v<T>) {
    std::string name;
    if (!read_text(json, name, "one of its named values", subject, diagnostics)) return;
    for (const auto& entry : enum_names<T>.entries)
      if (entry.name == name) {
        value = entry.value;
        return;
      }
    complain_choice(json, name, parameter_choices<T>(), subject, diagnostics);
  } else if constexpr (is_std_vector<T>::value) {
    if (!json.is(LocatedJson::Kind::array)) return complain_type(json, "a list", subject, diagnostics);
    value.clear();
    for (std::size_t i = 0; i < json.items.size(); ++i) {
      typename T::value_type element{};
      read_parameter(json.items[i], element, range, subject + "[" + std::to_string(i) + "]", diagnostics);
      value.push_back(std::move(element));
    }
  } else if constexpr (is_std_optional<T>::value) {
    if (json.is(LocatedJson::Kind::null)) {
      value.reset();
    } else {
      typename T::value_type element{};
      read_parameter(json, element, range, subject, diagnostics);
      value = std::move(element);
    }
  } else {
    read_struct(json, &value, struct_parameters<T>(), subject, diagnostics);
  }
}

template <class T>
Json write_parameter(const T& value) {
  if constexpr (std::is_same_v<T, FilePath>) {
    return value.path;
  } else if constexpr (std::is_same_v<T, GraphText>) {
    return value.json;
  } else if constexpr (std::is_same_v<T, Rational>) {
    return value.str();
  } else if constexpr (std::is_enum_v<T>) {
    for (const auto& entry : enum_names<T>.entries)
      if (entry.value == value) return std::string(entry.name);
    return nullptr;
  } else if constexpr (is_std_vector<T>::value) {
    Json list = Json::array();
    for (const auto& element : value) list.push_back(write_parameter(element));
    return list;
  } else if constexpr (is_std_optional<T>::value) {
    return value ? write_parameter(*value) : Json(nullptr);
  } else if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>) {
    return value;
  } else {
    return write_struct(&value, struct_parameters<T>());
  }
}

/// All that follows from the type of a parameter.
template <class T>
ParameterSpec spec_of_type() {
  ParameterSpec spec;
  spec.type = parameter_type<T>();
  spec.choices = parameter_choices<T>();
  spec.members = parameter_members<T>();
  spec.read = [](void* value, const LocatedJson& json, const Range& range, const std::string& subject,
                 Diagnostics& diagnostics) {
    read_parameter(json, *static_cast<T*>(value), range, subject, diagnostics);
  };
  spec.write = [](const void* value) { return write_parameter(*static_cast<const T*>(value)); };
  return spec;
}
// The usual types are compiled once, in parameter.cpp.
extern template ParameterSpec spec_of_type<bool>();
extern template ParameterSpec spec_of_type<int>();
extern template ParameterSpec spec_of_type<std::int64_t>();
extern template ParameterSpec spec_of_type<double>();
extern template ParameterSpec spec_of_type<std::string>();
extern template ParameterSpec spec_of_type<FilePath>();
extern template ParameterSpec spec_of_type<Rational>();
extern template ParameterSpec spec_of_type<std::vector<int>>();
extern template ParameterSpec spec_of_type<std::vector<double>>();
extern template ParameterSpec spec_of_type<std::vector<std::string>>();
extern template ParameterSpec spec_of_type<std::vector<FilePath>>();

/// Adds a parameter that lies at `value` in a struct at `owner` with the defaults.
ParameterSpec& add(std::vector<ParameterSpec>& specs, ParameterSpec spec, std::string name, const void* owner,
                   const void* value);

}  // namespace detail

/// What follows `param(...)` in a description.
class ParameterHandle {
 public:
  explicit ParameterHandle(ParameterSpec& spec) : spec_(spec) {}  // valid until the next param()
  ParameterHandle& doc(std::string text) { return spec_.doc = std::move(text), *this; }
  ParameterHandle& unit(std::string text) { return spec_.unit = std::move(text), *this; }
  ParameterHandle& within(double low, double high) { return spec_.range = {low, high, false}, *this; }
  ParameterHandle& at_least(double low) { return spec_.range.low = low, *this; }
  ParameterHandle& positive() { return spec_.range.low = 0, spec_.range.low_open = true, *this; }
  /// The graph must give it: there is no sensible default.
  ParameterHandle& required() { return spec_.required = true, *this; }

 private:
  ParameterSpec& spec_;
};

/// The parameters of a struct; a nested parameter struct describes itself with
/// `void parameters(Parameters<T>& p) { p.param("name", &T::name).doc("..."); }`.
template <class T>
class Parameters {
 public:
  template <class M>
  ParameterHandle param(const std::string& name, M T::*member) {
    const T defaults{};
    return ParameterHandle(detail::add(specs_, detail::spec_of_type<M>(), name, &defaults, &(defaults.*member)));
  }

  std::vector<ParameterSpec>& specs() { return specs_; }

 private:
  std::vector<ParameterSpec> specs_;
};

template <class T>
const std::vector<ParameterSpec>& detail::struct_parameters() {
  static const std::vector<ParameterSpec> specs = [] {
    Parameters<T> p;
    parameters(p);
    return std::move(p.specs());
  }();
  return specs;
}

}  // namespace talkgraph
