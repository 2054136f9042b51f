#include "graph/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

template class nlohmann::basic_json<nlohmann::ordered_map>;

namespace talkgraph {
namespace {

bool continues_character(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

int characters(std::string_view text) {
  return static_cast<int>(std::count_if(text.begin(), text.end(), [](char c) { return !continues_character(c); }));
}

/// Finds the place of each token of a text that a JSON parser has accepted so
/// far: nlohmann/json reports values but not where they stand.
class TokenPlaces {
 public:
  explicit TokenPlaces(std::shared_ptr<const SourceText> source) : source_(std::move(source)) {}

  Place next() {
    const std::string& text = source_->text;
    while (at_ < text.size() && std::string_view(" \t\r\n,:\xEF\xBB\xBF").find(text[at_]) != std::string_view::npos)
      ++at_;
    const std::size_t start = at_;
    if (at_ < text.size()) {
      const char c = text[at_];
      if (c == '"') {
        for (++at_; at_ < text.size() && text[at_] != '"'; ++at_)
          if (text[at_] == '\\') ++at_;
        ++at_;
      } else if (std::string_view("{}[]").find(c) != std::string_view::npos) {
        ++at_;
      } else {
        while (at_ < text.size() && std::string_view(" \t\r\n,:{}[]\"").find(text[at_]) == std::string_view::npos)
          ++at_;
      }
    }
    return at(start, at_ - start);
  }

  Place at(std::size_t offset, std::size_t length) {
    // Offsets only grow, so lines are counted once over the whole text.
    for (; counted_ < offset && counted_ < source_->text.size(); ++counted_)
      if (source_->text[counted_] == '\n') ++line_, line_start_ = counted_ + 1;
    const std::string_view text = source_->text;
    return {source_, line_, characters(text.substr(std::min(line_start_, text.size()), offset - line_start_)) + 1,
            std::max(1, characters(text.substr(std::min(offset, text.size()), length)))};
  }

 private:
  std::shared_ptr<const SourceText> source_;
  std::size_t at_ = 0, counted_ = 0, line_start_ = 0;
  int line_ = 1;
};

/// Lists and objects within each other; whatever walks through them recurses.
constexpr std::size_t deepest = 200;

class Builder final : public nlohmann::json_sax<Json> {
 public:
  Builder(std::shared_ptr<const SourceText> source, Diagnostics& diagnostics)
      : source_(source), places_(std::move(source)), diagnostics_(diagnostics) {}

  LocatedJson root;

  bool null() override { return put(LocatedJson::Kind::null, nullptr); }
  bool boolean(bool v) override { return put(LocatedJson::Kind::boolean, v); }
  bool number_integer(std::int64_t v) override { return put(LocatedJson::Kind::number, v); }
  bool number_unsigned(std::uint64_t v) override { return put(LocatedJson::Kind::number, v); }
  bool number_float(double v, const std::string&) override { return put(LocatedJson::Kind::number, v); }
  bool string(std::string& v) override { return put(LocatedJson::Kind::text, v); }
  bool binary(Json::binary_t&) override { return false; }

  bool start_object(std::size_t) override { return open(LocatedJson::Kind::object); }
  bool start_array(std::size_t) override { return open(LocatedJson::Kind::array); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(std::string& v) override {
    const Place place = places_.next();
    LocatedJson& object = *stack_.back();
    if (object.find(v)) diagnostics_.error(place, fmt::format("\"{}\" stands twice in this object: remove one", v));
    object.members.push_back({v, place, {}});
    return true;
  }
  bool parse_error(std::size_t position, const std::string&, const Json::exception& e) override {
    std::string what = e.what();
    if (const auto colon = what.find("syntax error"); colon != std::string::npos) what = what.substr(colon);
    TokenPlaces fresh(source_);
    diagnostics_.error(fresh.at(position ? position - 1 : 0, 1), "not valid JSON: " + what);
    return false;
  }

 private:
  LocatedJson& slot() {
    if (stack_.empty()) return root;
    LocatedJson& parent = *stack_.back();
    if (parent.is(LocatedJson::Kind::object)) return parent.members.back().value;
    return parent.items.emplace_back();
  }
  bool put(LocatedJson::Kind kind, Json value) {
    LocatedJson& s = slot();
    s.kind = kind;
    s.scalar = std::move(value);
    s.place = places_.next();
    return true;
  }
  bool open(LocatedJson::Kind kind) {
    if (stack_.size() == deepest) {
      diagnostics_.error(places_.next(), fmt::format("more than {} lists and objects within each other", deepest));
      return false;
    }
    LocatedJson& s = slot();
    s.kind = kind;
    s.place = places_.next();
    stack_.push_back(&s);
    return true;
  }
  bool close() {
    places_.next();
    stack_.pop_back();
    return true;
  }

  std::shared_ptr<const SourceText> source_;
  TokenPlaces places_;
  Diagnostics& diagnostics_;
  std::vector<LocatedJson*> stack_;
};

/// The characters of a place's line; what a terminal cannot show as one column is a blank.
std::vector<std::string> source_line(const Place& place) {
  std::size_t at = 0;
  const std::string& text = place.source->text;
  for (int line = 1; line < place.line; ++line) {
    at = text.find('\n', at);
    if (at == std::string::npos) return {};
    ++at;
  }
  std::vector<std::string> line;
  for (; at < text.size() && text[at] != '\n'; ++at) {
    if (continues_character(text[at]) && !line.empty())
      line.back() += text[at];
    else
      line.push_back(std::string(1, text[at]));
  }
  for (auto& c : line)
    if (Json(c).dump(-1, ' ', false, Json::error_handler_t::ignore).size() != c.size() + 2 && c != "\"" && c != "\\")
      c.assign(1, ' ');
  return line;
}

/// The line of a place with a caret below it, cut to what a terminal shows.
std::string excerpt(const Place& place) {
  constexpr std::size_t most = 120;
  const auto line = source_line(place);
  const std::size_t column = static_cast<std::size_t>(place.column) - 1;
  if (line.empty() || column > line.size()) return {};
  const std::size_t from = line.size() <= most || column < most / 2 ? 0 : column - most / 2;
  const std::size_t to = std::min(line.size(), from + most);
  std::string shown;
  for (std::size_t i = from; i < to; ++i) shown += line[i];
  const auto marks =
      std::clamp<std::size_t>(static_cast<std::size_t>(place.length), 1, std::max<std::size_t>(1, to - column));
  return fmt::format("{:>5} | {}{}{}\n      | {}^{}\n", place.line, from > 0 ? "..." : "", shown,
                     to < line.size() ? "..." : "", std::string(column - from + (from > 0 ? 3 : 0), ' '),
                     std::string(marks - 1, '~'));
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), row(b.size() + 1), two_before;
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    two_before = before;
    before = row;
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({before[j] + 1, row[j - 1] + 1, before[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], two_before[j - 2] + 1);
    }
  }
  return row.back();
}

}  // namespace

std::string Diagnostics::str() const {
  auto sorted = messages_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Message& a, const Message& b) {
    if (!a.place.source || !b.place.source) return !a.place.source && b.place.source;
    if (a.place.source != b.place.source) return a.place.source->name < b.place.source->name;
    return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
  });
  std::string out;
  for (const auto& m : sorted) {
    if (!m.place.source) {
      out += "error: " + m.text + "\n";
      continue;
    }
    out += fmt::format("{}:{}:{}: error: {}\n", m.place.source->name, m.place.line, m.place.column, m.text);
    out += excerpt(m.place);
  }
  if (!out.empty()) out.pop_back();  // the line end after the last
  return out;
}

const LocatedJson::Member* LocatedJson::find(std::string_view key) const {
  for (const auto& m : members)
    if (m.key == key) return &m;
  return nullptr;
}

LocatedJson::Member* LocatedJson::find(std::string_view key) {
  return const_cast<Member*>(std::as_const(*this).find(key));
}

Json LocatedJson::plain() const {
  if (kind == Kind::array) {
    Json list = Json::array();
    for (const auto& item : items) list.push_back(item.plain());
    return list;
  }
  if (kind == Kind::object) {
    Json object = Json::object();
    for (const auto& m : members) object[m.key] = m.value.plain();
    return object;
  }
  return scalar;
}

std::string_view LocatedJson::kind_name() const {
  switch (kind) {
    case Kind::null:
      return "null";
    case Kind::boolean:
      return "true or false";
    case Kind::number:
      return "a number";
    case Kind::text:
      return "text";
    case Kind::array:
      return "a list";
    case Kind::object:
      return "an object";
  }
  return "";
}

std::optional<LocatedJson> parse_json(std::shared_ptr<const SourceText> source, Diagnostics& diagnostics) {
  const std::string& text = source->text;
  Builder builder(std::move(source), diagnostics);  // which keeps the text
  if (!Json::sax_parse(text, &builder)) return {};
  return std::move(builder.root);
}

LocatedJson located(const Json& json, const Place& place) {
  LocatedJson out;
  out.place = place;
  if (json.is_array()) {
    out.kind = LocatedJson::Kind::array;
    for (const auto& item : json) out.items.push_back(located(item, place));
  } else if (json.is_object()) {
    out.kind = LocatedJson::Kind::object;
    for (const auto& [key, value] : json.items()) out.members.push_back({key, place, located(value, place)});
  } else {
    out.kind = json.is_null()      ? LocatedJson::Kind::null
               : json.is_boolean() ? LocatedJson::Kind::boolean
               : json.is_number()  ? LocatedJson::Kind::number
                                   : LocatedJson::Kind::text;
    out.scalar = json;
  }
  return out;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string* best = nullptr;
  std::size_t distance = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const auto& c : candidates)
    if (const auto d = edit_distance(word, c); d < distance) best = &c, distance = d;
  return best ? fmt::format(" (did you mean \"{}\"?)", *best) : "";
}

}  // namespace talkgraph
