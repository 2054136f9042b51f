// What a chain of ten pass-through nodes costs per item: processor time, as the machine may be shared.

#include <fmt/format.h>
#include <oneapi/tbb/flow_graph.h>
#include <oneapi/tbb/task_arena.h>
#include <unistd.h>

#include <array>
#include <filesystem>

#include "bench/child.h"
#include "bench/rows.h"
#include "graph/output_file.h"
#include "runtime/executor.h"

namespace talkgraph {
namespace bench {

constexpr std::uint64_t items = 1'000'000;
constexpr int nodes = 10;
constexpr int threads = 2;

struct Number {
  std::uint64_t value = 0;
};
inline void fields(Archive& ar, Number& n) { ar("value", n.value); }

}  // namespace bench

template <>
inline constexpr PortType port_type<bench::Number>{"Number", 1};

namespace bench {

struct Count {
  std::uint64_t to = items;
  Stream<Number> operator()() const {
    return Stream<Number>([to = to, i = std::uint64_t{0}]() mutable -> std::optional<Item<Number>> {
      if (i == to) return {};
      const auto n = i++;
      return Item<Number>{fmt::format_int(n).str(), {n}};
    });
  }
};
inline void describe(Description<Count>& d) { d.type("bench.count").summary("0, 1, 2, ...").output("out"); }

struct Pass {
  [[gnu::noinline]] Number operator()(const Number& n) const {
    asm volatile("");  // else a call without effect is left out
    return n;
  }
};
inline void describe(Description<Pass>& d) { d.type("bench.pass").summary("the same").input("in").output("out"); }

struct TenPasses {
  std::array<Pass, nodes> passes;
  Number operator()(Number n) const {
    for (const auto& pass : passes) n = pass(n);
    return n;
  }
};

/// Checks that numbers come in order and complete.
class Order {
 public:
  void take(std::uint64_t value) {
    if (value != next_++) throw std::logic_error("the items are out of order");
  }
  ~Order() noexcept(false) {
    if (next_ != items && !std::uncaught_exceptions()) throw std::logic_error("items are missing");
  }

 private:
  std::uint64_t next_ = 0;
};

void direct_calls() {
  const TenPasses ten;
  Order order;
  for (std::uint64_t i = 0; i < items; ++i) order.take(ten({i}).value);
}

Registry registry() {
  Registry r;
  r.add<Count>();
  r.add<Pass>();
  return r;
}

/// Through the interface that executors see, one thread, no books, no keys.
void functor_calls() {
  const Registry all = registry();
  const auto& type = *all.find("bench.pass");
  std::vector<std::unique_ptr<Functor>> chain;
  Diagnostics diagnostics;
  for (int n = 0; n < nodes; ++n) chain.push_back(type.make(nullptr, {}, type.name, diagnostics));
  Context context;
  Random random;
  std::vector<Input> inputs(1);
  std::vector<Value> outputs;
  Order order;
  for (std::uint64_t i = 0; i < items; ++i) {
    inputs[0].value = Value::of(Number{i});
    for (const auto& functor : chain) {
      functor->call(inputs, context, random, outputs);
      inputs[0].value = std::move(outputs[0]);
    }
    order.take(inputs[0].value.get<Number>().value);
  }
}

void talkgraph_chain(Executor executor) {
  const Registry all = registry();
  std::string text = R"({"nodes": {"n0": {"type": "bench.count"})";
  for (int n = 1; n <= nodes; ++n)
    text += fmt::format(R"(, "n{}": {{"type": "bench.pass", "in": {{"in": "n{}"}}}})", n, n - 1);
  text += fmt::format(R"(}}, "outputs": {{"out": "n{}"}}}})", nodes);
  Diagnostics diagnostics;
  const auto graph = load_graph_text("chain.json", text, all, diagnostics);
  if (!graph) throw std::logic_error(diagnostics.str());
  RunOptions options;
  options.executor = executor;
  options.threads = threads;
  options.folder = std::filesystem::temp_directory_path() / "talkgraph-bench";
  const auto result = run(*graph, options);
  Order order;
  for (const auto& item : result.output("out").items) order.take(item.value.get<Number>().value);
}

/// Serial nodes one behind the other and a sequencer.
void raw_tbb() {
  struct Message {
    std::size_t index = 0;
    std::shared_ptr<const Number> number;
  };
  namespace flow = tbb::flow;
  tbb::task_arena arena(threads);
  arena.execute([] {
    flow::graph graph;
    flow::input_node<Message> source(graph, [i = std::uint64_t{0}](tbb::flow_control& control) mutable {
      if (i == items) return control.stop(), Message{};
      const auto n = i++;
      return Message{n, std::make_shared<const Number>(Number{n})};
    });
    std::vector<std::unique_ptr<flow::function_node<Message, Message>>> chain;
    for (int n = 0; n < nodes; ++n) {
      chain.push_back(
          std::make_unique<flow::function_node<Message, Message>>(graph, flow::serial, [](const Message& in) {
            return Message{in.index, std::make_shared<const Number>(Pass{}(*in.number))};
          }));
      if (n > 0) flow::make_edge(*chain[chain.size() - 2], *chain.back());
    }
    flow::sequencer_node<Message> sequencer(graph, [](const Message& m) { return m.index; });
    Order order;
    flow::function_node<Message> last(graph, flow::serial, [&](const Message& m) { order.take(m.number->value); });
    flow::make_edge(source, *chain.front());
    flow::make_edge(*chain.back(), sequencer);
    flow::make_edge(sequencer, last);
    source.activate();
    graph.wait_for_all();
  });
}

std::vector<std::string> gstreamer(std::uint64_t buffers) {
  std::vector<std::string> command = {"gst-launch-1.0", "-q", "fakesrc", fmt::format("num-buffers={}", buffers)};
  for (int n = 0; n < nodes; ++n) command.insert(command.end(), {"!", "identity"});
  command.insert(command.end(), {"!", "fakesink"});
  return command;
}

/// 100 nodes: recordings, their sounds, and fourteen branches of seven nodes.
std::string hundred_nodes() {
  std::string text =
      R"({"nodes": {"files": {"type": "corpus.files", "params": {"files": ["speech.wav"]}},
  "parts": {"type": "corpus.parts", "in": {"recording": "files"}})";
  for (int b = 0; b < 14; ++b) {
    const auto add = [&](const char* name, const char* type, const char* port, const std::string& from,
                         const char* params) {
      text += fmt::format(",\n  \"{}{}\": {{\"type\": \"{}\", \"in\": {{\"{}\": \"{}\"}}, \"params\": {{{}}}}}", name,
                          b, type, port, from, params);
    };
    const auto branch = [&](const char* name) { return name + std::to_string(b); };
    add("frame", "speech.frame", "audio", "parts.audio", "");
    add("window", "speech.window", "frames", branch("frame"), "");
    add("spectrum", "speech.spectrum", "frames", branch("window"), "");
    add("mel", "speech.mel", "spectrum", branch("spectrum"), R"("filters": 26)");
    add("slow", "sync.polyphase", "track", branch("mel") + ".track", R"("rate": 25)");
    add("fast", "sync.polyphase", "track", branch("slow"), R"("rate": 100)");
    add("write", "write.hdf5", "value", branch("fast"), "");
  }
  return text + "}}\n";
}

void compare(const std::string& talkgraph) {
  std::vector<Row> rows = {
      {"ten direct calls", own(direct_calls)},
      {"ten calls of `Functor::call`", own(functor_calls)},
      {"talkgraph, serial executor", own([] { talkgraph_chain(Executor::serial); })},
      {"talkgraph, flow executor", own([] { talkgraph_chain(Executor::flow); })},
      {"oneTBB, serial nodes and a sequencer", own(raw_tbb)},
  };
  std::string missing;
  try {
    child_cpu_time(gstreamer(1));
    rows.push_back({"GStreamer, `fakesrc ! identity ×10 ! fakesink`",
                    [] { return child_cpu_time(gstreamer(items)) - child_cpu_time(gstreamer(1)); }});
  } catch (const std::runtime_error& e) {
    missing = fmt::format("\nGStreamer was not measured: {}\n", e.what());
  }
  measure(rows);
  const double yardstick = rows[4].median();
  fmt::print("Processor time per item, {} items, {} threads, median of {} (least to most):\n\n", items, threads,
             rounds);
  fmt::print("| chain of ten | ns per item | of oneTBB |\n|---|---|---|\n");
  for (const auto& row : rows) {
    const double scale = 1e9 / static_cast<double>(items);
    fmt::print("| {} | {:.0f} ({:.0f} to {:.0f}) | {:.2f} |\n", row.name, scale * row.median(),
               scale * row.seen.front(), scale * row.seen.back(), row.median() / yardstick);
  }
  fmt::print("{}\n", missing);

  const auto file = std::filesystem::temp_directory_path() / fmt::format("talkgraph-bench-{}.json", getpid());
  write_file(file, hundred_nodes());
  std::vector<Row> checks = {{"`talkgraph check`, 100 nodes",
                              [&] {
                                return child_cpu_time({talkgraph, "check", file.string()});
                              }},
                             {"`talkgraph --version`", [&] {
                                return child_cpu_time({talkgraph, "--version"});
                              }}};
  measure(checks);
  std::filesystem::remove(file);
  fmt::print("| start-up | ms of processor time |\n|---|---|\n");
  for (const auto& row : checks)
    fmt::print("| {} | {:.0f} ({:.0f} to {:.0f}) |\n", row.name, 1e3 * row.median(), 1e3 * row.seen.front(),
               1e3 * row.seen.back());
}

}  // namespace bench
}  // namespace talkgraph

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: bench_chain TALKGRAPH, the program whose start is measured\n");
    return 2;
  }
  try {
    talkgraph::bench::compare(argv[1]);
  } catch (const std::exception& e) {
    fmt::print(stderr, "bench_chain: {}\n", e.what());
    return 1;
  }
}
