#include "runtime/forecast.h"

#include <fmt/format.h>

#include "runtime/recipe.h"

namespace talkgraph {
namespace {

// Stands for any item of a stream whose items are not known ahead.
constexpr const char* any_item = "*";

std::size_t at(int i) { return static_cast<std::size_t>(i); }

bool kept(const NodeType& type) { return type.stored || type.sink; }

bool reads_nothing(const Graph::Node& node) {
  for (const auto& wire : node.inputs)
    if (!wire.sources.empty()) return false;
  return true;
}

}  // namespace

Forecast::Forecast(const Graph& graph, const Cache& cache, const std::atomic<bool>* cancel)
    : graph_(graph), cache_(cache) {
  const auto count = graph.nodes.size();
  recipes_.resize(count, Json::object());
  recipe_keys_.resize(count);
  ranks_.resize(count);
  reads_all_.resize(count);
  keys_.resize(count);
  needs_.resize(count, Need::call);
  wanted_.resize(count);
  for (std::size_t n = 0; n < count; ++n) {
    const auto& type = *graph.nodes[n].type;
    wanted_[n] = type.sink;
    if (type.makes_stream) {
      domain(static_cast<int>(n)).known = reads_nothing(graph.nodes[n]);
    } else if (graph.nodes[n].domain >= 0) {
      ranks_[n] = domain(graph.nodes[n].domain).nodes.size();
      domain(graph.nodes[n].domain).nodes.push_back(static_cast<int>(n));
    }
  }
  for (const auto& output : graph.outputs) wanted_[at(output.source.node)] = true;
  for (std::size_t n = 0; n < count; ++n) {
    make_keys(static_cast<int>(n), cancel);
    reads_all_[n] = reads_all(static_cast<int>(n));
  }
  for (std::size_t n = count; n-- > 0;) decide(static_cast<int>(n));
}

// ---- keys ------------------------------------------------------------------

void Forecast::make_keys(int n, const std::atomic<bool>* cancel) {
  const bool source = node(n).type->makes_stream;
  // The items of a source without inputs have keys of their own: its paths need not be read.
  if (!source || !domain(n).known) {
    FilesRead read;
    recipes_[at(n)] = talkgraph::recipe(graph_, n);
    recipe_files_.insert(recipe_files_.end(), read.stamps.begin(), read.stamps.end());
    recipe_keys_[at(n)] = KeyMaker().add(recipes_[at(n)].dump()).key();
  }
  if (source) {
    if (domain(n).known)
      learn_items(n, cancel);
    else
      expect_items(n);
  } else if (node(n).domain < 0) {
    keys_[at(n)] = call_key(n, nullptr);
  } else {
    for_each_row(domain(node(n).domain), [&](Row& row) { row.keys[rank(n)] = call_key(n, &row); });
  }
}

void Forecast::learn_items(int source, const std::atomic<bool>* cancel) {
  auto& d = domain(source);
  Context context;
  context.cancel = cancel;
  Random random(graph_.seed, node(source).type->name, "");
  const std::vector<Input> inputs(node(source).inputs.size());
  std::optional<AnyStream> stream;
  std::size_t asked = 0;
  // What fails here fails again in the run, which says so.
  const auto attempt = [&](auto f) {
    try {
      return f();
    } catch (const Cancelled&) {
      throw;
    } catch (const std::exception&) {
      d.failed = true;
      return stream && asked < stream->size().value_or(0);
    }
  };
  attempt([&] {
    stream.emplace(node(source).functor->stream(inputs, context, random));
    return true;
  });
  while (stream && attempt([&] {
           context.check_cancelled();
           ++asked;
           FilesRead read;
           auto item = stream->next();
           if (!item) return false;
           d.rows.push_back(new_row(d, item->key, made_by(source, item->value)));
           d.rows.back().files = std::move(read.stamps);
           if (!d.at.emplace(item->key, &d.rows.back()).second) d.failed = true;
           return true;
         })) {
  }
  KeyMaker all;
  for (const auto& row : d.rows) {
    all.add(row.item);
    for (const auto& key : row.made) all.add(key);
  }
  keys_[at(source)] = all.key();
}

void Forecast::expect_items(int source) {
  auto& d = domain(source);
  keys_[at(source)] = call_key(source, nullptr);
  std::vector<Key> made;
  for (std::size_t p = 0; p < node(source).type->outputs.size(); ++p)
    made.push_back(KeyMaker().add(keys_[at(source)]).add(fmt::format("all of {}", p)).key());
  d.whole = new_row(d, any_item, std::move(made));
}

std::vector<Key> Forecast::made_by(int source, const std::vector<Value>& values) const {
  const auto& type = *node(source).type;
  std::vector<Key> keys;
  for (const auto& value : values)
    // What a handle will read or draw is the work of its maker, so that counts beside what the handle tells.
    keys.push_back(
        KeyMaker().add(type.name).add(std::to_string(type.version)).add(value ? content_key(value) : Key()).key());
  return keys;
}

Forecast::Row Forecast::new_row(const Domain& d, std::string item, std::vector<Key> made) {
  Row row{std::move(item), std::move(made), {}, {}, {}, {}};
  row.keys.resize(d.nodes.size());
  row.needs.resize(d.nodes.size(), Need::call);
  row.wanted.resize(d.nodes.size());
  return row;
}

std::vector<std::pair<std::string, Key>> Forecast::input_keys(int n, const Row* row) const {
  std::vector<std::pair<std::string, Key>> keys;
  for (std::size_t p = 0; p < node(n).inputs.size(); ++p) {
    const auto& wire = node(n).inputs[p];
    const auto& port = node(n).type->inputs[p].name;
    for (std::size_t s = 0; s < wire.sources.size(); ++s) {
      const std::string name = wire.names.empty() ? port : port + "/" + wire.names[s];
      const bool gathered = way(graph_, wire, wire.sources[s]) == Way::gathered;
      keys.emplace_back(name, gathered ? gathered_key(wire.sources[s]) : port_key(wire.sources[s], row));
    }
  }
  return keys;
}

Key Forecast::call_key(int n, const Row* row) const {
  KeyMaker maker;
  maker.add(recipe_keys_[at(n)]).add(row ? row->item : "");
  for (const auto& [name, key] : input_keys(n, row)) maker.add(name).add(key);
  return maker.key();
}

Key Forecast::port_key(Graph::Port port, const Row* row) const {
  if (node(port.node).type->makes_stream) return row->made[at(port.port)];
  const Key call = node(port.node).domain < 0 ? keys_[at(port.node)] : row->keys[rank(port.node)];
  return node(port.node).type->outputs.size() == 1 ? call : KeyMaker().add(call).add(std::to_string(port.port)).key();
}

Key Forecast::gathered_key(Graph::Port port) const {
  const auto found = gathered_.find({port.node, port.port});
  if (found != gathered_.end()) return found->second;
  const auto& d = domain(node(port.node).output_domain(port.node));
  KeyMaker maker;
  if (d.known)
    for (const auto& row : d.rows) maker.add(row.item).add(port_key(port, &row));
  else
    maker.add(port_key(port, &d.whole));
  return gathered_[{port.node, port.port}] = maker.key();
}

bool Forecast::reads_all(int n) const {
  bool all = node(n).domain < 0 && !node(n).type->makes_stream;
  for_each_source(graph_, n, [&](std::size_t, Graph::Port source, Way way) {
    all = all || way != Way::item || reads_all_[at(source.node)];
  });
  return all;
}

std::filesystem::path Forecast::changed_file(int n, const std::string& item) const {
  std::filesystem::path changed;
  const auto look = [&](const std::vector<FileStamp>& files) {
    for (const auto& file : files)
      if (changed.empty() && FileStamp::of(file.path) != file) changed = file.path;
  };
  look(recipe_files_);
  if (!reads_all_[at(n)]) {
    if (const Row* r = row(n, item)) look(r->files);
  } else {
    for (const auto& [source, d] : domains_) {
      const std::shared_lock lock(d.mutex);
      for (const auto& r : d.rows) look(r.files);
    }
  }
  return changed;
}

// ---- needs -----------------------------------------------------------------

Need Forecast::need_of(int n, const Key& key, bool wanted) const {
  if (!wanted) return Need::skip;
  return kept(*node(n).type) && cache_.has(key) ? Need::load : Need::call;
}

void Forecast::decide(int n) {
  if (node(n).type->makes_stream) {
    auto& d = domain(n);
    bool wanted = wanted_[at(n)] || d.failed;
    for_each_row(d, [&](Row& row) {
      for (const Need need : row.needs) wanted = wanted || need != Need::skip;
    });
    needs_[at(n)] = wanted ? Need::call : Need::skip;
    if (wanted) want_inputs(n, nullptr);
  } else if (node(n).domain < 0) {
    needs_[at(n)] = need_of(n, keys_[at(n)], wanted_[at(n)]);
    if (needs_[at(n)] == Need::call) want_inputs(n, nullptr);
  } else {
    const auto& d = domain(node(n).domain);
    for_each_row(domain(node(n).domain), [&](Row& row) {
      const bool wanted = wanted_[at(n)] || row.wanted[rank(n)];
      // Whether an item that is not known yet lies in the cache shows when the run has made it.
      auto& need = row.needs[rank(n)];
      need = d.known ? need_of(n, row.keys[rank(n)], wanted) : wanted ? Need::call : Need::skip;
      if (need == Need::call) want_inputs(n, &row);
    });
  }
}

void Forecast::want_inputs(int n, Row* row) {
  for_each_source(graph_, n, [&](std::size_t, Graph::Port source, Way way) {
    if (way == Way::item && !node(source.node).type->makes_stream)
      row->wanted[rank(source.node)] = true;
    else
      wanted_[at(source.node)] = true;
  });
}

void Forecast::enter(int source, const std::string& item, const std::vector<Value>& outputs) {
  auto& d = domain(source);
  if (d.known) {
    if (!d.at.contains(item) && !d.failed)
      throw std::runtime_error(fmt::format("item \"{}\" was not there when the run began", item));
    return;
  }
  Row row = new_row(d, item, made_by(source, outputs));
  for (const int n : d.nodes) row.keys[rank(n)] = call_key(n, &row);
  for (auto n = d.nodes.rbegin(); n != d.nodes.rend(); ++n) {
    auto& need = row.needs[rank(*n)];
    need = need_of(*n, row.keys[rank(*n)], wanted_[at(*n)] || row.wanted[rank(*n)]);
    if (need != Need::call) continue;
    for_each_source(graph_, *n, [&](std::size_t, Graph::Port from, Way way) {
      if (way == Way::item && !node(from.node).type->makes_stream) row.wanted[rank(from.node)] = true;
    });
  }
  const std::unique_lock lock(d.mutex);
  d.rows.push_back(std::move(row));
  d.at.emplace(item, &d.rows.back());
}

// ---- asking ----------------------------------------------------------------

const Forecast::Row* Forecast::row(int n, const std::string& item) const {
  if (node(n).type->makes_stream || node(n).domain < 0) return nullptr;
  const auto& d = domain(node(n).domain);
  const std::shared_lock lock(d.mutex);
  const auto found = d.at.find(item);
  return found == d.at.end() ? nullptr : found->second;
}

Need Forecast::need(int n, const std::string& item) const {
  if (node(n).type->makes_stream || node(n).domain < 0) return needs_[at(n)];
  const Row* r = row(n, item);
  return r ? r->needs[rank(n)] : Need::call;
}

Key Forecast::key(int n, const std::string& item) const {
  if (node(n).type->makes_stream || node(n).domain < 0) return keys_[at(n)];
  const Row* r = row(n, item);
  return r ? r->keys[rank(n)] : Key();
}

std::vector<std::pair<std::string, Need>> Forecast::needs(int n) const {
  if (node(n).type->makes_stream || node(n).domain < 0) return {{"", needs_[at(n)]}};
  std::vector<std::pair<std::string, Need>> all;
  for (const auto& row : domain(node(n).domain).rows) all.emplace_back(row.item, row.needs[rank(n)]);
  return all;
}

Forecast::Counts Forecast::counts(int n) const {
  Counts counts;
  auto all = needs(n);
  if (node(n).domain >= 0 && !domain(node(n).domain).known) {
    counts.foreseen = false;
    all = {{any_item, domain(node(n).domain).whole.needs[rank(n)]}};
  }
  for (const auto& [item, need] : all)
    ++(need == Need::call ? counts.call : need == Need::load ? counts.load : counts.skip);
  return counts;
}

std::vector<std::pair<std::string, Key>> Forecast::items(int source) const {
  std::vector<std::pair<std::string, Key>> all;
  for (const auto& row : domain(source).rows) {
    KeyMaker made;
    for (const auto& key : row.made) made.add(key);
    all.emplace_back(row.item, made.key());
  }
  return all;
}

Json Forecast::about(int n, const std::string& item) const {
  Json inputs = Json::object();
  for (const auto& [name, key] : input_keys(n, row(n, item))) inputs[name] = key.str();
  return {{"recipe", recipes_[at(n)]}, {"item", item}, {"inputs", inputs}};
}

}  // namespace talkgraph
