#include "runtime/call.h"

#include <fmt/format.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <optional>
#include <set>

#include "graph/output_file.h"
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

/// Libraries that write files seldom say why they could not.
std::string disk_note(const std::filesystem::path& folder) {
  std::error_code error;
  const auto space = std::filesystem::space(folder, error);
  return !error && space.available < 1'000'000 ? " (the disk is full)" : "";
}

/// Whether a node may write files: the run folder is known to those that ask for a Context.
bool writes(const NodeType& type) { return type.sink && type.uses_context; }

std::string call_name(const std::string& node, const std::string& item) {
  return item.empty() ? fmt::format("node \"{}\"", node) : fmt::format("node \"{}\", item \"{}\"", node, item);
}

std::string place_of(const Place& place) {
  if (!place.source) return "";
  return fmt::format("{}:{}:{}", place.source->name, place.line, place.column);
}

NodeStats empty_books(const Graph::Node& node) {
  NodeStats books;
  books.in.resize(node.inputs.size());
  books.out.resize(node.type->outputs.size());
  return books;
}

void add(NodeStats& sum, const NodeStats& part) {
  const auto add_ports = [](std::vector<PortCount>& to, const std::vector<PortCount>& from) {
    for (std::size_t p = 0; p < to.size(); ++p) to[p].items += from[p].items, to[p].values += from[p].values;
  };
  sum.calls += part.calls;
  sum.skipped += part.skipped;
  sum.failed += part.failed;
  sum.loaded += part.loaded;
  sum.unneeded += part.unneeded;
  sum.saved += part.saved;
  sum.kept += part.kept;
  sum.wall += part.wall;
  sum.cpu += part.cpu;
  add_ports(sum.in, part.in);
  add_ports(sum.out, part.out);
}

}  // namespace

/// An empty folder where a sink writes before its files go to the run folder and the cache; cleared away behind it. It
/// is on the disk of the run folder: a full cache must not stop a sink.
class Caller::Desk {
 public:
  explicit Desk(const std::filesystem::path& folder) : path_(folder / fmt::format(".desk-{}-XXXXXX", getpid())) {
    std::filesystem::create_directories(folder);
    if (!mkdtemp(path_.data()))
      throw std::runtime_error(fmt::format("{} cannot be written: {}", folder.string(), std::strerror(errno)));
  }
  ~Desk() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Desk(const Desk&) = delete;
  Desk& operator=(const Desk&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// Books the time of a call, and tells observers of it. Reading clocks costs more than a cheap call does: where calls
/// take microseconds, one of several is timed and stands for all of them.
class Caller::Watch {
 public:
  Watch(const Caller& caller, Station& station) : caller_(caller), station_(station), weight_(weight(station.books)) {
    for (auto* o : caller_.options_.observers) o->call_started(station_.node, station_.context.item);
    if (weight_ == 0) return;
    wall_ = nanoseconds(CLOCK_MONOTONIC);
    cpu_ = nanoseconds(CLOCK_THREAD_CPUTIME_ID);
  }
  ~Watch() {
    if (weight_ > 0) {
      station_.books.wall += weight_ * static_cast<double>(nanoseconds(CLOCK_MONOTONIC) - wall_);
      station_.books.cpu += weight_ * static_cast<double>(nanoseconds(CLOCK_THREAD_CPUTIME_ID) - cpu_);
    }
    for (auto* o : caller_.options_.observers) o->call_ended(station_.node, station_.context.item);
  }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

 private:
  /// How many calls the next one stands for. Judged by processor time: a thread may have had to wait for its turn.
  static double weight(const NodeStats& books) {
    const auto calls = static_cast<double>(books.calls);
    const std::uint64_t one_of = books.calls < 32 || books.cpu > 1e-5 * calls ? 1 : books.cpu > 1e-6 * calls ? 32 : 256;
    return (books.calls & (one_of - 1)) == 0 ? 1e-9 * static_cast<double>(one_of) : 0;
  }

  const Caller& caller_;
  Station& station_;
  const double weight_;  // times nanoseconds
  std::int64_t wall_ = 0, cpu_ = 0;
};

std::string Failure::str() const {
  return fmt::format("{}{}{}: {}", place, place.empty() ? "" : ": error: ", call_name(node, item), cause);
}

Caller::Caller(const Graph& graph, const RunOptions& options, Keeper* keeper)
    : graph_(graph), options_(options), keeper_(keeper), books_(graph.nodes.size()) {
  for (std::size_t n = 0; n < books_.size(); ++n) books_[n] = empty_books(graph.nodes[n]);
}

std::vector<Input> Caller::fixed_inputs(int n, const std::function<Value(Graph::Port)>& single,
                                        const std::function<Gathered(Graph::Port)>& gathered) {
  std::vector<Input> inputs(node(n).inputs.size());
  auto& books = books_[static_cast<std::size_t>(n)];
  for (std::size_t p = 0; p < inputs.size(); ++p) {
    const auto& wire = node(n).inputs[p];
    const bool collects = node(n).type->inputs[p].kind == PortSpec::Kind::collected;
    for (std::size_t s = 0; s < wire.sources.size(); ++s) {
      const auto& source = wire.sources[s];
      switch (way(graph_, wire, source)) {
        case Way::gathered: {
          const Gathered all = gathered(source);
          inputs[p].collected = *all.values;
          books.in[p].items += all.items;
          books.in[p].values += all.values->size();
          break;
        }
        case Way::single: {
          Value value = single(source);
          Station::count(books.in[p], value);
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

Station& Caller::station(int n, std::vector<Input> fixed_inputs) {
  const std::lock_guard lock(mutex_);
  auto& station = stations_.emplace_back();
  station.node = n;
  station.functor = node(n).functor.get();
  station.inputs = std::move(fixed_inputs);
  for_each_source(graph_, n, [&](std::size_t p, Graph::Port, Way w) {
    if (w == Way::item) station.item_ports.push_back(p);
  });
  const auto& ports = node(n).type->inputs;
  for (std::size_t p = 0; p < ports.size(); ++p)
    if (ports[p].kind == PortSpec::Kind::item) station.required.push_back(p);
  station.books = empty_books(node(n));
  auto& context = station.context;
  context.folder = options_.folder;
  if (node(n).type->uses_provenance) context.provenance = provenance(graph_, n);
  context.cancel = options_.cancel;
  context.stop = &stop_;
  context.on_progress = [this, s = &station](double share) {
    for (auto* o : options_.observers) o->progress(s->node, s->context.item, share);
  };
  context.on_log = [this, s = &station](std::string_view message) {
    for (auto* o : options_.observers) o->log(s->node, s->context.item, message);
  };
  context.on_warning = [this, s = &station](std::string_view message) {
    for (auto* o : options_.observers) o->warn(s->node, s->context.item, message);
  };
  return station;
}

void Caller::sent(Station& station, const std::vector<Value>& outputs) {
  for (std::size_t p = 0; p < outputs.size(); ++p) Station::count(station.books.out[p], outputs[p]);
}

void Caller::failed(Station& station, const std::string& item, std::string cause) {
  check_stopped();
  const int n = station.node;
  Failure failure{node(n).name, item, place_of(node(n).place), std::move(cause)};
  station.books.failed += 1;
  {
    const std::lock_guard lock(mutex_);
    failures_.push_back(failure);
    failed_.emplace_back(n, item);
  }
  if (!options_.keep_going) throw RunError(std::move(failure));
  for (auto* o : options_.observers) o->failed(failure);
}

std::vector<Value>& Caller::call(Station& station, const std::string& item) {
  check_stopped();
  const int n = station.node;
  station.context.item = item;
  station.outputs.clear();
  if (keeper_)
    load_or_compute(station, *keeper_);
  else
    compute(station);
  for (const auto p : station.item_ports) station.inputs[p].value = {};
  station.outputs.resize(node(n).type->outputs.size());
  sent(station, station.outputs);
  for (auto* o : options_.observers) o->item_done(n, item);
  return station.outputs;
}

void Caller::load_or_compute(Station& station, Keeper& keeper) {
  const int n = station.node;
  const auto& item = station.context.item;
  switch (keeper.forecast().need(n, item)) {
    case Need::skip:
      station.books.unneeded += 1;
      break;
    case Need::load:
      load(station);
      break;
    case Need::call: {
      const auto claim = keeper.claim(n, item);
      if (keeper.made_meanwhile(n, item))
        load(station);
      else
        compute(station);
      break;
    }
  }
}

void Caller::load(Station& station) {
  const Watch watch(*this, station);
  const int n = station.node;
  const auto& item = station.context.item;
  station.books.loaded += 1;
  Cache::Result result;
  try {
    for (const auto& file : keeper_->files(n, item)) claim(station, file);
    result = keeper_->load(n, item);
  } catch (const Cache::Damaged&) {
    throw;
  } catch (...) {
    return failed(station, item, cause_of(std::current_exception()) + disk_note(options_.folder));
  }
  for (auto* o : options_.observers) o->loaded(n, item);
  station.books.saved += result.seconds;
  station.books.kept += result.bytes;
  for (const auto& warning : result.warnings)
    for (auto* o : options_.observers) o->warn(n, item, warning);
  station.outputs = std::move(result.outputs);
}

void Caller::compute(Station& station) {
  const int n = station.node;
  const auto& type = *node(n).type;
  if (!station.complete()) {
    station.books.skipped += 1;
    return;
  }
  if (type.uses_random) station.random = Random(graph_.seed, type.name, station.context.item);
  const Watch watch(*this, station);
  station.books.calls += 1;
  if (keeper_ && keeper_->keeps(n))
    for (auto* o : options_.observers) o->missed(n, station.context.item);
  try {
    if (writes(type) || (keeper_ && keeper_->keeps(n)))
      call_and_keep(station);
    else
      station.functor->call(station.inputs, station.context, station.random, station.outputs);
  } catch (const Cancelled&) {
    throw;
  } catch (...) {
    station.outputs.clear();
    failed(station, station.context.item,
           cause_of(std::current_exception()) + (type.sink ? disk_note(options_.folder) : ""));
  }
}

void Caller::call_and_keep(Station& station) {
  const int n = station.node;
  const auto& item = station.context.item;
  Cache::Result result;
  std::optional<Desk> desk;
  Context context = station.context;
  context.on_warning = [&](std::string_view message) {
    result.warnings.emplace_back(message);
    station.context.warn(message);
  };
  if (writes(*node(n).type)) context.folder = desk.emplace(options_.folder).path();
  const auto start = nanoseconds(CLOCK_MONOTONIC);
  station.functor->call(station.inputs, context, station.random, station.outputs);
  if (desk) deliver(station, desk->path());
  result.seconds = 1e-9 * static_cast<double>(nanoseconds(CLOCK_MONOTONIC) - start);
  if (!keeper_ || tainted(n, item)) return;
  result.outputs = station.outputs;
  station.books.kept += keeper_->keep(n, item, result, desk ? desk->path() : "");
}

void Caller::claim(const Station& station, const std::filesystem::path& file) {
  const std::lock_guard lock(mutex_);
  const auto [at, first] = written_.emplace(file, call_name(node(station.node).name, station.context.item));
  if (!first)
    throw std::runtime_error(
        fmt::format("{} is written by {} already: each needs a folder or name of its own", file.string(), at->second));
  for (auto* o : options_.observers) o->writes(file.string());
}

std::vector<std::string> Caller::files() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> files;
  for (const auto& [file, call] : written_) files.push_back(file.string());
  return files;
}

void Caller::deliver(const Station& station, const std::filesystem::path& desk) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(desk))
    if (entry.is_regular_file()) claim(station, entry.path().lexically_relative(desk));
  put_files(desk, options_.folder);
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
  auto all = books_;
  for (const auto& station : stations_) add(all[static_cast<std::size_t>(station.node)], station.books);
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

OpenSource::OpenSource(Caller& caller, int node, std::vector<Input> inputs, Keys& keys)
    : caller_(caller),
      station_(caller.station(node, std::move(inputs))),
      random_(caller.graph_.seed, caller.node(node).type->name, ""),
      keys_(keys) {
  caller_.check_stopped();
  if (caller_.keeper_ && caller_.keeper_->forecast().need(node, "") == Need::skip) return;
  if (!station_.complete()) {
    station_.books.skipped += 1;
    return;
  }
  try {
    const Caller::Watch watch(caller_, station_);
    stream_.emplace(caller_.node(node).functor->stream(station_.inputs, station_.context, random_));
    if (const auto size = stream_->size()) caller_.domain_size(node, *size);
  } catch (const Cancelled&) {
    throw;
  } catch (...) {
    caller_.failed(station_, "", cause_of(std::current_exception()));
  }
  station_.inputs.clear();
}

std::optional<Item<std::vector<Value>>> OpenSource::pull() {
  for (;;) {
    const Caller::Watch watch(caller_, station_);
    try {
      ++pulled_;
      return stream_->next();
    } catch (const Cancelled&) {
      throw;
    } catch (...) {
      // The key of the item that failed is not known, that of the one before is.
      const auto cause = cause_of(std::current_exception());
      caller_.failed(station_, "",
                     keys_.empty() ? fmt::format("the first item: {}", cause)
                                   : fmt::format("the item after \"{}\": {}", keys_.back(), cause));
      // A source of unknown length might fail for ever.
      if (pulled_ >= stream_->size().value_or(0)) return {};
    }
  }
}

std::optional<std::vector<Value>> OpenSource::next() {
  while (stream_) {
    caller_.check_stopped();
    auto item = pull();
    if (!item) {
      stream_.reset();
      break;
    }
    if (!keys_.add(item->key)) {
      caller_.failed(station_, item->key, "this key came before: the keys of a source must be unique");
      continue;
    }
    const int node = station_.node;
    station_.books.calls += 1;
    item->value.resize(caller_.node(node).type->outputs.size());
    if (caller_.keeper_) caller_.keeper_->forecast().enter(node, item->key, item->value);
    Caller::sent(station_, item->value);
    for (auto* o : caller_.options_.observers) o->item_done(node, item->key);
    return std::move(item->value);
  }
  return {};
}

}  // namespace talkgraph
