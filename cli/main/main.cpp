#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "cli/annotate.h"
#include "cli/cache.h"
#include "cli/corpus.h"
#include "cli/example.h"
#include "cli/experiment.h"
#include "cli/look.h"
#include "cli/reference.h"
#include "cli/run.h"
#include "cli/samples.h"
#include "cli/speak.h"
#include "cli/study_make.h"
#include "cli/study_report.h"
#include "cli/study_serve.h"
#include "experiment/experiment.h"
#include "graph/output_file.h"
#include "graph/plugin.h"
#include "graph/schema.h"
#include "nodes/all_nodes.h"
#include "nodes/model/save.h"
#include "runtime/why.h"
#include "study/design.h"

namespace {

using namespace talkgraph;
using namespace talkgraph::cli;

/// A graph file, or the graph that a model file keeps.
std::optional<Graph> load(const std::string& file, const Registry& registry, const std::vector<std::string>& sets) {
  Diagnostics diagnostics;
  auto graph = std::filesystem::path(file).extension() == ".h5"
                   ? load_graph_text(file, model_graph(file), registry, diagnostics, {sets})
                   : load_graph(file, registry, diagnostics, {sets});
  if (!graph) fmt::print(stderr, "{}\n", diagnostics.str());
  return graph;
}

int check(const std::vector<std::string>& files, const Registry& registry, const std::vector<std::string>& sets) {
  int code = success;
  for (const auto& file : files) {
    const auto graph = load(file, registry, sets);
    if (graph)
      fmt::print("{}: {} nodes, sound\n", file, graph->nodes.size());
    else
      code = usage;
  }
  return code;
}

/// To a file, or to standard output where none is named.
void deliver(const std::string& text, const std::string& file) {
  if (file.empty())
    fmt::print("{}", text);
  else
    write_file(file, text);
}

int diff(const std::string& file, const std::string& other, const Registry& registry,
         const std::vector<std::string>& sets) {
  const auto a = load(file, registry, {}), b = load(other, registry, sets);
  if (!a || !b) return usage;
  fmt::print("{}", diff_graphs(*a, *b));
  return success;
}

int why(const std::string& file, const Registry& registry, const std::vector<std::string>& sets, const RunCommand& run,
        const std::string& node) {
  const auto graph = load(file, registry, sets);
  if (!graph) return usage;
  const auto kept = open_cache(run);
  const Cache& cache = *kept;
  const Forecast forecast(*graph, cache);
  fmt::print(
      "{}", explain(*graph, forecast, last_snapshot(cache, *graph), node.empty() ? std::nullopt : std::optional(node)));
  return success;
}

int show(const NodeType& type, const Registry& registry, bool only_example) {
  fmt::print("{}", only_example ? graph_text(example_graph(registry, type)) : show_node(registry, type));
  return success;
}

int write_reference(const Registry& registry, const std::filesystem::path& folder) {
  for (const auto& [name, text] : reference_pages(registry)) write_file(folder / name, text);
  return success;
}

int draw(const std::string& file, const Registry& registry, const std::vector<std::string>& sets,
         const std::string& format, const std::string& output) {
  const auto graph = load(file, registry, sets);
  if (!graph) return usage;
  deliver(format == "mermaid" ? draw_mermaid(*graph) : format == "dot" ? draw_dot(*graph) : draw_svg(*graph), output);
  return success;
}

/// "500MB"; a negative one would be taken for a huge one.
void take_size(CLI::Option* option) {
  const auto refuse_negative = [](const std::string& text) {
    return text.starts_with('-') ? std::string("must not be negative") : std::string();
  };
  option->transform(CLI::AsSizeValue(true))->transform(CLI::Validator(refuse_negative, ""));
}

void add_progress(CLI::App& app, std::optional<ProgressStyle>& style) {
  app.add_option("--progress", style, "terminal, plain or json (default: as it fits standard error)")
      ->transform(CLI::CheckedTransformer(std::map<std::string, ProgressStyle>{
          {"terminal", ProgressStyle::terminal}, {"plain", ProgressStyle::plain}, {"json", ProgressStyle::json}}));
  app.add_flag_callback(
      "-q,--quiet", [&style] { style = ProgressStyle::quiet; }, "no progress, only warnings and failures");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"talkgraph: learn a talking face from recordings of one speaker, then let new speech drive it"};
  app.require_subcommand(1);
  app.set_version_flag("--version", "talkgraph " TALKGRAPH_VERSION);
  std::vector<std::string> plugins;
  app.add_option("--plugin", plugins, "shared library with nodes of your own; any number, before or after the command")
      ->take_all()
      ->allow_extra_args(false);
  app.fallthrough();
  std::vector<std::string> sets, files;
  std::string graph, word, type, format = "svg", output;
  RunCommand run;
  SpeakCommand speech;

  ExperimentCommand experiment;

  auto* run_app = app.add_subcommand("run", "run a graph");
  run_app->add_option("graph", graph, "graph file")->required();
  auto* experiment_app =
      app.add_subcommand("experiment", "run a graph with many settings and compare what comes of it");
  experiment_app->add_option("experiment", graph, "experiment file")->required();
  experiment_app->add_flag("--dry-run", experiment.dry_run, "list the runs, and how much of each is kept already");
  take_size(
      experiment_app->add_option("--memory", experiment.memory, "most that runs beside each other may take, as 8GB"));
  bool no_cache = false;
  for (auto* c : {run_app, experiment_app}) {
    c->add_option("--set", run.sets, "path=value, or parameter=value")->take_all()->allow_extra_args(false);
    c->add_option("-o,--folder", run.folder, "folder for results (default: below runs/)");
    c->add_flag("--overwrite", run.overwrite, "write to a folder that holds other results already");
    c->add_option("--threads", run.threads, "threads")->check(CLI::Range(1, 256));
    c->add_flag("--keep-going", run.keep_going, "finish what can be finished, list what failed");
    c->add_option("--cache", run.cache, "folder that keeps results (default: $TALKGRAPH_CACHE, or ~/.cache/talkgraph)");
    c->add_flag("--no-cache", no_cache, "compute everything, keep nothing");
    take_size(c->add_option("--cache-size", run.cache_limit, "most that the cache may hold, as 500MB or 20GB")
                  ->capture_default_str());
    add_progress(*c, run.progress);
  }
  run_app->add_flag("--serial", run.serial, "one thread, node by node");
  run_app->add_option("--trace", run.trace, "file that the Perfetto and Chrome trace viewers open");

  auto* cache_app = app.add_subcommand("cache", "look after the kept results");
  cache_app->require_subcommand(1);
  std::uint64_t keep = 0;
  auto* info_app = cache_app->add_subcommand("info", "where they are, how many, of what");
  auto* verify_app = cache_app->add_subcommand("verify", "read all of them and remove the damaged ones");
  auto* prune_app = cache_app->add_subcommand("prune", "remove the longest unused, or all");
  take_size(prune_app->add_option("--size", keep, "what may stay, as 500MB or 2GB (default: nothing)"));
  for (auto* c : {info_app, verify_app, prune_app})
    c->add_option("--cache", run.cache, "the folder, if not the usual one")->check(CLI::ExistingDirectory);

  auto* why_app = app.add_subcommand("why", "what a run would compute, and because of what");
  why_app->add_option("graph", graph, "graph file")->required();
  why_app->add_option("node", word, "one node, with its items");
  why_app->add_option("--set", sets, "path=value")->take_all()->allow_extra_args(false);
  why_app->add_option("--cache", run.cache, "the folder of kept results, if not the usual one");

  auto* speak_app = app.add_subcommand("speak", "animate new speech with a trained model");
  speak_app->add_option("model", speech.model, "model file that a run wrote")->required();
  speak_app->add_option("speech", speech.files, "sound files");
  speak_app->add_option("--text", speech.text, "what espeak-ng shall say, instead of sound files");
  speak_app
      ->add_option("--transcript", speech.transcripts,
                   "what a sound file says, or a .txt file of it; once for each, in order")
      ->take_all()
      ->allow_extra_args(false);
  speak_app->add_option("-o,--output", speech.output, "clip (.mp4 or .webm); a folder for several sound files");
  speak_app->add_option("--visemes", speech.visemes, "viseme track (.tsv or .json) in Rhubarb's format");
  speak_app->add_option("--base", speech.base, "clip or still to draw upon");
  speak_app->add_option("--set", speech.sets, "change the model's graph: path=value")
      ->take_all()
      ->allow_extra_args(false);
  speak_app->add_option("--threads", speech.threads, "threads")->check(CLI::Range(1, 256));
  add_progress(*speak_app, speech.progress);

  CorpusCommand corpus;
  auto* corpus_app = app.add_subcommand("corpus", "make a corpus of a folder of clips, or look one over");
  corpus_app->require_subcommand(1);
  auto* corpus_check_app =
      corpus_app->add_subcommand("check", "clips, rates, damage, sound against picture, phones, and what is missing");
  corpus_check_app->add_option("corpus", corpus.source, "manifest, or folder of the GRID corpus")->required();
  corpus_check_app->add_flag("--json", corpus.json, "the same for programs");
  corpus_check_app->add_option("--threads", run.threads, "threads")->check(CLI::Range(1, 256));
  corpus_check_app->add_option("--cache", run.cache, "the folder of kept results, if not the usual one");
  corpus_check_app->add_flag("--no-cache", no_cache, "compute everything, keep nothing");
  add_progress(*corpus_check_app, run.progress);
  auto* corpus_new_app = corpus_app->add_subcommand("new", "write a manifest of the clips in a folder");
  corpus_new_app->add_option("folder", corpus.source, "with videos, and what belongs to them beside them")->required();
  corpus_new_app->add_option("-o,--output", corpus.output, "the manifest (default: manifest.json in the folder)");
  corpus_new_app->add_flag("--overwrite", corpus.overwrite, "replace a manifest that is there");
  corpus_new_app->add_option("--validation", corpus.validation, "share of the clips for validation")
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str();
  corpus_new_app->add_option("--test", corpus.test, "share of the clips for the test")
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str();
  corpus_new_app->add_option("--rate", corpus.rate, "frames per second of folders of pictures");

  AnnotateCommand annotation;
  auto* annotate_app = app.add_subcommand("annotate", "mark the face in a few frames, on a page in your browser");
  annotate_app->add_option("manifest", graph, "manifest of the recordings")->required();
  annotate_app->add_option("--frames", annotation.project.frames, "how many frames to annotate")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  annotate_app->add_option("--port", annotation.port, "of the page; 0: any free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  annotate_app->add_option("--scheme", annotation.project.scheme,
                           "point scheme, by its name or .json file (default: the manifest's, else ibug68)");
  annotate_app->add_option("--seed", annotation.project.seed, "of the choice of frames")->capture_default_str();

  auto* study_app = app.add_subcommand("study", "ask people what they think of synthetic faces");
  study_app->require_subcommand(1);
  StudyMakeCommand study_make;
  auto* study_make_app = study_app->add_subcommand("make", "choose and draw the clips");
  study_make_app->add_option("study", study_make.design, "study file")->required();
  study_make_app->add_option("runs", study_make.runs, "folders of finished runs")->required();
  study_make_app->add_option("-o,--folder", study_make.folder, "folder for the study")->required();
  study_make_app->add_option("--threads", run.threads, "threads")->check(CLI::Range(1, 256));
  study_make_app->add_option("--cache", run.cache, "the folder of kept results, if not the usual one");
  study_make_app->add_flag("--no-cache", no_cache, "compute everything, keep nothing");
  add_progress(*study_make_app, run.progress);
  StudyServeCommand study_serve;
  auto* study_serve_app = study_app->add_subcommand("serve", "serve the page on which people take a study");
  study_serve_app->add_option("folder", graph, "of the study")->required();
  study_serve_app->add_option("--port", study_serve.server.port, "of the page; 0: any free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  study_serve_app->add_option("--listen", study_serve.server.listen, "address; only this computer reaches the default")
      ->capture_default_str();
  study_serve_app->add_option("--url", study_serve.server.url, "by which people reach the page, behind a proxy for one")
      ->check(CLI::Validator(
          [](const std::string& url) {
            return url.starts_with("http://") || url.starts_with("https://") ? ""
                                                                             : "must begin with http:// or https://";
          },
          "URL"));
  study_serve_app->add_option("--invite", study_serve.invite, "print so many new links, each for one person")
      ->check(CLI::Range(0, 10000));

  StudyReportCommand study_report;
  auto* study_report_app =
      study_app->add_subcommand("report", "write what people answered: tables, tests, plots, a page");
  study_report_app->add_option("folder", graph, "of the study")->required();
  study_report_app->add_option("-o,--output", study_report.output, "folder (default: report/ in that of the study)");
  study_report_app->add_flag("--finished-only", study_report.options.finished_only,
                             "leave out the answers of people who have not finished");
  study_report_app
      ->add_option_function<std::string>(
          "--correction",
          [&](const std::string& name) {
            for (const auto& entry : enum_names<Correction>.entries)
              if (entry.name == name) study_report.options.correction = entry.value;
          },
          "of p-values for the number of tests")
      ->check(CLI::IsMember({"holm", "benjamini_hochberg", "none"}))
      ->default_str("holm");

  auto* check_app = app.add_subcommand("check", "check graphs without running them");
  check_app->add_option("graphs", files, "graph files")->required();
  check_app->add_option("--set", sets, "path=value")->take_all()->allow_extra_args(false);

  auto* nodes_app = app.add_subcommand("nodes", "list the node types");
  nodes_app->add_option("word", word, "only those that speak of it");

  auto* node_app = app.add_subcommand("node", "show one node type: ports, parameters, an example");
  node_app->add_option("type", type, "such as speech.mel")->required();
  bool only_example = false;
  node_app->add_flag("--example", only_example, "only the example, to be run");

  auto* samples_app = app.add_subcommand("samples", "write recordings and a model for the examples that read files");
  samples_app->add_option("-o,--folder", run.folder, "folder (default samples)");
  add_progress(*samples_app, run.progress);

  auto* reference_app = app.add_subcommand("reference", "write the reference of all node types in Markdown");
  reference_app->add_option("-o,--folder", output, "folder")->required();

  std::string other;
  auto* diff_app = app.add_subcommand("diff", "what two graphs do differently");
  diff_app->add_option("graph", graph, "graph file")->required();
  diff_app->add_option("other", other, "another one (default: the same, with --set)");
  diff_app->add_option("--set", sets, "path=value, in the second graph")->take_all()->allow_extra_args(false);

  auto* schema_app =
      app.add_subcommand("schema", "write the JSON Schema of graphs, experiments or studies, for editors");
  bool of_experiments = false, of_studies = false;
  auto* of_experiments_flag = schema_app->add_flag("--experiment", of_experiments, "of experiment files");
  schema_app->add_flag("--study", of_studies, "of study files")->excludes(of_experiments_flag);
  schema_app->add_option("-o,--output", output, "file (default: standard output)");

  auto* draw_app = app.add_subcommand("draw", "draw a graph");
  draw_app->add_option("graph", graph, "graph file")->required();
  draw_app->add_option("--format", format, "svg, dot or mermaid")->check(CLI::IsMember({"svg", "dot", "mermaid"}));
  draw_app->add_option("-o,--output", output, "file (default: standard output)");
  draw_app->add_option("--set", sets, "path=value")->take_all()->allow_extra_args(false);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? success : usage;
  }

  try {
    Registry registry = all_nodes();
    for (const auto& plugin : plugins) load_plugin(plugin, registry);
    const auto command = [&]() -> int {
      run.cached = !no_cache;
      if (*run_app) return run_file(graph, run, registry);
      if (*experiment_app) return experiment.run = run, run_experiment(graph, experiment, registry);
      if (*info_app) return fmt::print("{}", cache_info(*open_cache(run))), success;
      if (*verify_app) return cache_verify(*open_cache(run)) ? failed : success;
      if (*prune_app) return fmt::print("{} freed\n", size_text(open_cache(run)->prune(keep))), success;
      if (*why_app) return why(graph, registry, sets, run, word);
      if (*speak_app) return speak(speech, registry);
      if (*corpus_check_app) return check_corpus(corpus, run, registry);
      if (*corpus_new_app) return new_corpus(corpus);
      if (*study_make_app) return run_study_make(study_make, run, registry);
      if (*annotate_app) return run_annotate(graph, annotation);
      if (*study_report_app) return run_study_report(graph, study_report);
      if (*study_serve_app) return run_study_serve(graph, study_serve);
      if (*check_app) return check(files, registry, sets);
      if (*nodes_app) return fmt::print("{}", list_nodes(registry, word)), success;
      if (*diff_app) return diff(graph, other.empty() ? graph : other, registry, sets);
      if (*schema_app)
        return deliver((of_experiments ? experiment_schema()
                        : of_studies   ? study::design_schema()
                                       : json_schema(registry))
                               .dump(1) +
                           "\n",
                       output),
               success;
      if (*node_app) return show(known_type(registry, type), registry, only_example);
      if (*samples_app) return write_samples(run, registry);
      if (*reference_app) return write_reference(registry, output);
      return draw(graph, registry, sets, format, output);
    };
    const int code = command();
    if (std::fflush(stdout) != 0) throw std::runtime_error("standard output cannot be written to");
    return code;
  } catch (const Cancelled&) {
    fmt::print(stderr, "stopped\n");
    return cancelled;
  } catch (const std::invalid_argument& e) {
    fmt::print(stderr, "talkgraph: {}\n", e.what());
    return usage;
  } catch (const std::exception& e) {
    fmt::print(stderr, "talkgraph: {}\n", e.what());
    return failed;
  }
}
