#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// Compiled once, in json.cpp.
extern template class nlohmann::basic_json<nlohmann::ordered_map>;

namespace talkgraph {

using Json = nlohmann::ordered_json;

/// A text that places point into: a JSON file, or a --set argument.
struct SourceText {
  std::string name;
  std::string text;
};

/// A stretch of a source text; line and column count from 1, columns in characters.
struct Place {
  std::shared_ptr<const SourceText> source;
  int line = 0;
  int column = 0;
  int length = 1;
};

/// Messages about a graph, gathered so that all are reported in one go.
class Diagnostics {
 public:
  struct Message {
    Place place;
    std::string text;
  };

  void error(const Place& place, std::string text) { messages_.push_back({place, std::move(text)}); }
  bool ok() const { return messages_.empty(); }
  const std::vector<Message>& messages() const { return messages_; }
  /// file:line:column: error: text, then the line and a caret, in file order.
  std::string str() const;

 private:
  std::vector<Message> messages_;
};

/// JSON whose every value remembers its place.
struct LocatedJson {
  enum class Kind { null, boolean, number, text, array, object };

  struct Member;

  Kind kind = Kind::null;
  Json scalar;                     ///< null, boolean, number or text
  std::vector<LocatedJson> items;  ///< of an array
  std::vector<Member> members;     ///< of an object, in file order
  Place place;

  bool is(Kind k) const { return kind == k; }
  const Member* find(std::string_view key) const;
  Member* find(std::string_view key);
  Json plain() const;
  /// "a number", "an object": for messages.
  std::string_view kind_name() const;
};

struct LocatedJson::Member {
  std::string key;
  Place key_place;
  LocatedJson value;
};

/// Parses a text; syntax errors and duplicate keys go to `diagnostics`. Nothing
/// is given for what is not JSON.
std::optional<LocatedJson> parse_json(std::shared_ptr<const SourceText> source, Diagnostics& diagnostics);

/// Gives every value of `json` the same place.
LocatedJson located(const Json& json, const Place& place);

/// The nearest of `candidates` as ` (did you mean "x"?)`, or nothing.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace talkgraph
