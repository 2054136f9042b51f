#include "graph/parameter.h"

#include <fmt/format.h>

#include <filesystem>

namespace talkgraph::detail {
namespace {

std::string join(const std::vector<std::string>& words) {
  std::string all;
  for (const auto& word : words) all += (all.empty() ? "" : ", ") + word;
  return all;
}

/// What a struct's members are where a graph leaves them out: what the owner of the struct gives them, if it does.
void set_initials(std::vector<ParameterSpec>& members, const Json& owner) {
  if (!owner.is_object()) return;
  for (auto& member : members) {
    member.initial = owner.at(member.name);
    set_initials(member.members, member.initial);
  }
}

}  // namespace

void complain_type(const LocatedJson& json, std::string_view expected, const std::string& subject,
                   Diagnostics& diagnostics) {
  diagnostics.error(json.place, fmt::format("{} must be {}, got {}", subject, expected,
                                            json.is(LocatedJson::Kind::text)     ? json.scalar.dump()
                                            : json.is(LocatedJson::Kind::number) ? json.scalar.dump()
                                                                                 : std::string(json.kind_name())));
}

bool check_range(double value, const Range& range, const LocatedJson& json, const std::string& subject,
                 Diagnostics& diagnostics) {
  std::string wanted;
  if (range.low_open ? !(value > range.low) : !(value >= range.low))
    wanted = fmt::format("{} {}", range.low_open ? "greater than" : "at least", range.low);
  else if (!(value <= range.high))
    wanted = fmt::format("at most {}", range.high);
  if (wanted.empty()) return true;
  diagnostics.error(json.place, fmt::format("{} must be {}, got {}", subject, wanted, json.scalar.dump()));
  return false;
}

bool read_number(const LocatedJson& json, double& value, const Range& range, const std::string& subject,
                 Diagnostics& diagnostics) {
  if (!json.is(LocatedJson::Kind::number)) return complain_type(json, "a number", subject, diagnostics), false;
  value = json.scalar.get<double>();
  return check_range(value, range, json, subject, diagnostics);
}

bool read_integer(const LocatedJson& json, std::int64_t& value, const Range& range, double type_low, double type_high,
                  const std::string& subject, Diagnostics& diagnostics) {
  const double number = json.is(LocatedJson::Kind::number) ? json.scalar.get<double>() : NAN;
  if (!(number == std::floor(number))) return complain_type(json, "a whole number", subject, diagnostics), false;
  if (!check_range(number, range, json, subject, diagnostics)) return false;
  if (!check_range(number, {std::max(type_low, -9e18), std::min(type_high, 9e18), false}, json, subject, diagnostics))
    return false;
  value = json.scalar.is_number_float() ? static_cast<std::int64_t>(number) : json.scalar.get<std::int64_t>();
  return true;
}

bool read_text(const LocatedJson& json, std::string& value, std::string_view expected, const std::string& subject,
               Diagnostics& diagnostics) {
  if (!json.is(LocatedJson::Kind::text)) return complain_type(json, expected, subject, diagnostics), false;
  value = json.scalar.get<std::string>();
  return true;
}

void read_path(const LocatedJson& json, FilePath& value, const std::string& subject, Diagnostics& diagnostics) {
  if (!read_text(json, value.path, "a file or folder name", subject, diagnostics)) return;
  const std::filesystem::path given(value.path);
  if (given.empty() || given.is_absolute() || !json.place.source) return;
  const auto folder = std::filesystem::path(json.place.source->name).parent_path();
  value.path = std::filesystem::absolute(folder / given).lexically_normal().string();
}

void read_rational(const LocatedJson& json, Rational& value, const Range& range, const std::string& subject,
                   Diagnostics& diagnostics) {
  if (!json.is(LocatedJson::Kind::number) && !json.is(LocatedJson::Kind::text))
    return complain_type(json, "a ratio such as 25 or \"30000/1001\"", subject, diagnostics);
  try {
    value = Rational::parse(json.is(LocatedJson::Kind::text) ? json.scalar.get<std::string>() : json.scalar.dump());
    check_range(value.value(), range, json, subject, diagnostics);
  } catch (const std::invalid_argument& e) {
    diagnostics.error(json.place, fmt::format("{}: {}", subject, e.what()));
  }
}

void complain_choice(const LocatedJson& json, const std::string& given, const std::vector<std::string>& choices,
                     const std::string& subject, Diagnostics& diagnostics) {
  diagnostics.error(json.place, fmt::format("{} must be one of {}, got \"{}\"{}", subject, join(choices), given,
                                            did_you_mean(given, choices)));
}

void read_struct(const LocatedJson& json, void* target, const std::vector<ParameterSpec>& specs,
                 const std::string& subject, Diagnostics& diagnostics) {
  if (!json.is(LocatedJson::Kind::object)) return complain_type(json, "an object", subject, diagnostics);
  std::vector<std::string> names;
  for (const auto& spec : specs) names.push_back(spec.name);
  for (const auto& member : json.members) {
    bool known = false;
    for (const auto& spec : specs)
      if (spec.name == member.key) {
        known = true;
        spec.read(static_cast<std::byte*>(target) + spec.offset, member.value, spec.range,
                  fmt::format("{}: parameter \"{}\"", subject, spec.name), diagnostics);
      }
    if (!known)
      diagnostics.error(member.key_place, fmt::format("{}: unknown parameter \"{}\"{}", subject, member.key,
                                                      did_you_mean(member.key, names)));
  }
  for (const auto& spec : specs)
    if (spec.required && !json.find(spec.name))
      diagnostics.error(json.place,
                        fmt::format("{}: parameter \"{}\" must be given: {}", subject, spec.name, spec.doc));
}

template ParameterSpec spec_of_type<bool>();
template ParameterSpec spec_of_type<int>();
template ParameterSpec spec_of_type<std::int64_t>();
template ParameterSpec spec_of_type<double>();
template ParameterSpec spec_of_type<std::string>();
template ParameterSpec spec_of_type<FilePath>();
template ParameterSpec spec_of_type<Rational>();
template ParameterSpec spec_of_type<std::vector<int>>();
template ParameterSpec spec_of_type<std::vector<double>>();
template ParameterSpec spec_of_type<std::vector<std::string>>();
template ParameterSpec spec_of_type<std::vector<FilePath>>();

ParameterSpec& add(std::vector<ParameterSpec>& specs, ParameterSpec spec, std::string name, const void* owner,
                   const void* value) {
  spec.name = std::move(name);
  spec.offset = static_cast<const std::byte*>(value) - static_cast<const std::byte*>(owner);
  spec.initial = spec.write(value);
  set_initials(spec.members, spec.initial);
  return specs.emplace_back(std::move(spec));
}

Json write_struct(const void* target, const std::vector<ParameterSpec>& specs) {
  Json out = Json::object();
  for (const auto& spec : specs) out[spec.name] = spec.write(static_cast<const std::byte*>(target) + spec.offset);
  return out;
}

}  // namespace talkgraph::detail
