#include "runtime/call.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <exception>

#include "runtime/plan.h"

namespace talkgraph {
namespace {

std::int64_t nanoseconds(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

std::string cause_of(const std::exception_ptr& thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    return "out of memory";
  } catch (const std::exception& e) {
    return e.what();
  } catch (...) {
    return "an exception of unknown type";
  }
}

std::string place_of(const Place& place) {
  if (!place.source) return "";
  return fmt::format("{}:{}:{}", place.source->name, place.line, place.column);
}

}  // namespace

/// Where a sink writes before its files go to the run folder and the cache; cleared away behind it.
struct Caller::Desk {
  explicit Desk(std::filesystem::path p) : path(std::move(p)) {}
  ~Desk() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  std::filesystem::path path;
};

/// Books the time of a call, and tells observers of it.
class Caller::Watch {
 public:
  Watch(Caller& caller, int node, std::string item)
      : caller_(caller),
        node_(node),
        item_(std::move(item)),
        wall_(nanoseconds(CLOCK_MONOTONIC)),
        cpu_(nanoseconds(CLOCK_THREAD_CPUTIME_ID)) {
    for (auto* o : caller_.options_.observers) o->call_started(node_, item_);
  }
  ~Watch() {
    caller_.books(node_).wall += nanoseconds(CLOCK_MONOTONIC) - wall_;
    caller_.books(node_).cpu += nanoseconds(CLOCK_THREAD_CPUTIME_ID) - cpu_;
    for (auto* o : caller_.options_.observers) o->call_ended(node_, item_);
  }

 private:
  Caller& caller_;
  int node_;
  std::string item_;
  std::int64_t wall_, cpu_;
};

std::string Failure::str() const {
  return fmt::format("{}{}node \"{}\"{}: {}", place, place.empty() ? "" : ": error: ", node,
                     item.empty() ? "" : fmt::format(", item \"{}\"", item), cause);
}

Caller::Caller(const Graph& graph, const RunOptions& options, Keeper* keeper)
    : graph_(graph), options_(options), keeper_(keeper), books_(graph.nodes.size()) {
  for (std::size_t n = 0; n < books_.size(); ++n) {
    books_[n].in.resize(graph.nodes[n].inputs.size());
    books_[n].out.resize(graph.nodes[n].type->outputs.size());
  }
}

std::vector<Input> Caller::fixed_inputs(int n, const std::function<Value(Graph::Port)>& single,
                                        const std::function<Gathered(Graph::Port)>& gathered) {
  std::vector<Input> inputs(node(n).inputs.size());
  for (std::size_t p = 0; p < inputs.size(); ++p) {
    const auto& wire = node(n).inputs[p];
    const bool collects = node(n).type->inputs[p].kind == PortSpec::Kind::collected;
    for (std::size_t s = 0; s < wire.sources.size(); ++s) {
      const auto& source = wire.sources[s];
      switch (way(graph_, wire, source)) {
        case Way::gathered: {
          const Gathered all = gathered(source);
          inputs[p].collected = *all.values;
          books(n).in[p].add(all.items, all.values->size());
          break;
        }
        case Way::single: {
          Value value = single(source);
          books(n).in[p].add(1, value ? 1 : 0);
          if (!collects)
            inputs[p].value = std::move(value);
          else if (value)
            inputs[p].collected.push_back({wire.names.at(s), std::move(value)});
          break;
        }
        case Way::item:
          break;
      }
    }
  }
  return inputs;
}

void Caller::add_item_inputs(int n, std::vector<Input>& inputs, const std::function<const Value&(Graph::Port)>& item) {
  for_each_source(graph_, n, [&](std::size_t p, Graph::Port source, Way w) {
    if (w != Way::item) return;
    inputs[p].value = item(source);
    books(n).in[p].add(1, inputs[p].value ? 1 : 0);
  });
}

bool Caller::complete(int n, const std::vector<Input>& inputs) const {
  for (std::size_t p = 0; p < inputs.size(); ++p)
    if (node(n).type->inputs[p].kind == PortSpec::Kind::item && !inputs[p].value) return false;
  return true;
}

Context Caller::context(int n, const std::string& item) const {
  Context context;
  context.item = item;
  context.folder = options_.folder;
  if (node(n).type->uses_provenance) context.provenance = provenance(graph_, n);
  context.cancel = options_.cancel;
  context.stop = &stop_;
  context.on_progress = [this, n, item](double share) {
    for (auto* o : options_.observers) o->progress(n, item, share);
  };
  context.on_log = [this, n, item](std::string_view message) {
    for (auto* o : options_.observers) o->log(n, item, message);
  };
  context.on_warning = [this, n, item](std::string_view message) {
    for (auto* o : options_.observers) o->warn(n, item, message);
  };
  return context;
}

void Caller::sent(int n, const std::vector<Value>& outputs) {
  for (std::size_t p = 0; p < outputs.size(); ++p) books(n).out[p].add(1, outputs[p] ? 1 : 0);
}

void Caller::failed(int n, const std::string& item, std::string cause) {
  check_stopped();
  Failure failure{node(n).name, item, place_of(node(n).place), std::move(cause)};
  books(n).failed += 1;
  {
    const std::lock_guard lock(mutex_);
    failures_.push_back(failure);
    failed_.emplace_back(n, item);
  }
  if (!options_.keep_going) throw RunError(std::move(failure));
  for (auto* o : options_.observers) o->failed(failure);
}

std::vector<Value> Caller::call(int n, const std::string& item, std::vector<Input> inputs) {
  check_stopped();
  std::vector<Value> outputs;
  switch (keeper_ ? keeper_->forecast().need(n, item) : Need::call) {
    case Need::skip:
      books(n).unneeded += 1;
      break;
    case Need::load:
      outputs = load(n, item);
      break;
    case Need::call:
      outputs = compute(n, item, inputs);
      break;
  }
  outputs.resize(node(n).type->outputs.size());
  sent(n, outputs);
  for (auto* o : options_.observers) o->item_done(n, item);
  return outputs;
}

std::vector<Value> Caller::load(int n, const std::string& item) {
  const Watch watch(*this, n, item);
  auto result = keeper_->load(n, item);
  books(n).loaded += 1;
  for (auto* o : options_.observers) o->loaded(n, item);
  books(n).saved += static_cast<std::int64_t>(1e9 * result.seconds);
  for (const auto& warning : result.warnings)
    for (auto* o : options_.observers) o->warn(n, item, warning);
  return std::move(result.outputs);
}

std::vector<Value> Caller::compute(int n, const std::string& item, const std::vector<Input>& inputs) {
  const bool kept = keeper_ && keeper_->keeps(n);
  Cache::Result result;
  std::optional<Desk> desk;
  if (!complete(n, inputs)) {
    books(n).skipped += 1;
  } else {
    const Watch watch(*this, n, item);
    books(n).calls += 1;
    const auto start = nanoseconds(CLOCK_MONOTONIC);
    try {
      Context surroundings = context(n, item);
      if (kept) {
        surroundings.on_warning = [&, tell = surroundings.on_warning](std::string_view message) {
          result.warnings.emplace_back(message);
          tell(message);
        };
        if (node(n).type->sink) surroundings.folder = desk.emplace(keeper_->desk()).path;
      }
      Random random(graph_.seed, node(n).type->name, item);
      result.outputs = node(n).functor->call(inputs, surroundings, random);
      if (desk) keeper_->deliver(desk->path);
    } catch (const Cancelled&) {
      throw;
    } catch (...) {
      failed(n, item, cause_of(std::current_exception()));
      return {};
    }
    result.seconds = 1e-9 * static_cast<double>(nanoseconds(CLOCK_MONOTONIC) - start);
  }
  if (kept && !tainted(n, item)) keeper_->keep(n, item, result, desk ? desk->path : std::filesystem::path());
  return std::move(result.outputs);
}

bool Caller::tainted(int n, const std::string& item) const {
  const std::lock_guard lock(mutex_);
  if (failed_.empty()) return false;
  std::set<std::pair<int, bool>> seen;  // a node, and whether only the item counts
  std::vector<std::pair<int, bool>> open = {{n, true}};
  while (!open.empty()) {
    const auto [at, by_item] = open.back();
    open.pop_back();
    if (!seen.insert({at, by_item}).second) continue;
    for (const auto& [failed_node, failed_item] : failed_)
      if (failed_node == at && (!by_item || failed_item == item)) return true;
    for_each_source(graph_, at, [&](std::size_t, Graph::Port source, Way way) {
      open.emplace_back(source.node, by_item && way == Way::item);
    });
  }
  return false;
}

void Caller::domain_size(int source, std::size_t items) const {
  for (auto* o : options_.observers) o->domain_size(source, items);
}

std::vector<NodeStats> Caller::stats() const {
  const auto counts = [](const std::deque<Count>& from) {
    std::vector<PortCount> all;
    for (const auto& c : from) all.push_back({c.items, c.values});
    return all;
  };
  std::vector<NodeStats> all;
  for (const auto& b : books_) {
    NodeStats s;
    s.calls = b.calls;
    s.skipped = b.skipped;
    s.failed = b.failed;
    s.loaded = b.loaded;
    s.unneeded = b.unneeded;
    s.saved = 1e-9 * static_cast<double>(b.saved);
    s.wall = 1e-9 * static_cast<double>(b.wall);
    s.cpu = 1e-9 * static_cast<double>(b.cpu);
    s.in = counts(b.in);
    s.out = counts(b.out);
    all.push_back(std::move(s));
  }
  return all;
}

/// In the order of the graph's nodes, then of the keys: the same for any number of threads.
std::vector<Failure> Caller::failures() const {
  const std::lock_guard lock(mutex_);
  auto all = failures_;
  const auto rank = [&](const Failure& f) {
    return std::find_if(graph_.nodes.begin(), graph_.nodes.end(), [&](const auto& n) { return n.name == f.node; }) -
           graph_.nodes.begin();
  };
  std::stable_sort(all.begin(), all.end(), [&](const Failure& a, const Failure& b) {
    return std::make_pair(rank(a), a.item) < std::make_pair(rank(b), b.item);
  });
  return all;
}

OpenSource::OpenSource(Caller& caller, int node, std::vector<Input> inputs)
    : caller_(caller),
      node_(node),
      context_(caller.context(node, "")),
      random_(caller.graph_.seed, caller.node(node).type->name, "") {
  caller_.check_stopped();
  if (caller_.keeper_ && caller_.keeper_->forecast().need(node, "") == Need::skip) return;
  if (!caller_.complete(node, inputs)) {
    caller_.books(node).skipped += 1;
    return;
  }
  const Caller::Watch watch(caller_, node, "");
  try {
    stream_.emplace(caller_.node(node).functor->stream(inputs, context_, random_));
    if (const auto size = stream_->size()) caller_.domain_size(node, *size);
  } catch (const Cancelled&) {
    throw;
  } catch (...) {
    caller_.failed(node, "", cause_of(std::current_exception()));
  }
}

std::optional<Item<std::vector<Value>>> OpenSource::pull() {
  for (;;) {
    const Caller::Watch watch(caller_, node_, "");
    try {
      ++pulled_;
      return stream_->next();
    } catch (const Cancelled&) {
      throw;
    } catch (...) {
      // The key of the item that failed is not known, that of the one before is.
      const auto cause = cause_of(std::current_exception());
      caller_.failed(node_, "",
                     last_.empty() ? fmt::format("the first item: {}", cause)
                                   : fmt::format("the item after \"{}\": {}", last_, cause));
      // A source of unknown length might fail for ever.
      if (pulled_ >= stream_->size().value_or(0)) return {};
    }
  }
}

std::optional<Item<std::vector<Value>>> OpenSource::next() {
  while (stream_) {
    caller_.check_stopped();
    auto item = pull();
    if (!item) {
      stream_.reset();
      break;
    }
    last_ = item->key;
    if (!keys_.insert(item->key).second) {
      caller_.failed(node_, item->key, "this key came before: the keys of a source must be unique");
      continue;
    }
    caller_.books(node_).calls += 1;
    item->value.resize(caller_.node(node_).type->outputs.size());
    if (caller_.keeper_) caller_.keeper_->forecast().enter(node_, item->key, item->value);
    caller_.sent(node_, item->value);
    for (auto* o : caller_.options_.observers) o->item_done(node_, item->key);
    return item;
  }
  return {};
}

}  // namespace talkgraph
