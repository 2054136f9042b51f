#include "nodes/plot/convergence.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "nodes/plot/latent_space.h"
#include "nodes/plot/svg.h"
#include "nodes/types/gp_regression.h"

namespace talkgraph {
namespace {

/// The costs of one state at the start and after each iteration.
struct Costs {
  std::string name, ended;
  std::vector<double> values;
  std::int64_t frames;

  double after(std::size_t iteration) const { return values[std::min(iteration, values.size() - 1)]; }
  std::size_t iterations() const { return values.size() - 1; }
};

std::vector<Costs> costs_of(const Value& model, bool per_frame) {
  std::vector<Costs> all;
  const auto add = [&](const std::string& name, const std::string& ended, const std::vector<double>& trace,
                       std::int64_t frames) {
    Costs c{name, ended.empty() ? "not told" : ended, {}, frames};
    for (const double ln_p : trace) c.values.push_back(per_frame ? -ln_p / static_cast<double>(frames) : -ln_p);
    if (!c.values.empty()) all.push_back(std::move(c));
  };
  if (model && model.type().type == port_type<GpRegression>) {
    const auto& gp = model.get<GpRegression>();
    add("", gp.ended, gp.trace, gp.frames);
  } else {
    for (const auto& space : latent_spaces(model)) add(space.label, space.ended, *space.trace, space.latents->rows());
  }
  if (all.empty()) throw std::runtime_error("the model has kept no costs of its training; train it anew");
  return all;
}

Series curve(const std::string& name, std::size_t iterations, const auto& value) {
  Series s{name, {}, {}};
  for (std::size_t i = 0; i <= iterations; ++i) {
    s.x.push_back(static_cast<double>(i));
    s.y.push_back(value(i));
  }
  return s;
}

std::vector<Panel> panel_each(const std::vector<Costs>& all, const std::string& y_label) {
  std::vector<Panel> panels;
  for (const auto& c : all) {
    const std::string title = c.name.empty() ? c.ended : c.name + ": " + c.ended;
    panels.push_back(
        {title, "iteration", y_label, {curve("cost", c.iterations(), [&](std::size_t i) { return c.after(i); })}});
  }
  return panels;
}

/// The value below which a share of sorted ones lies, between neighbours by their distance.
double quantile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const double rest = at - static_cast<double>(below);
  return rest > 0 ? (1 - rest) * sorted[below] + rest * sorted[below + 1] : sorted[below];
}

Panel panel_of_many(std::vector<Costs> all, std::size_t worst, const std::string& y_label) {
  std::stable_sort(all.begin(), all.end(), [](const Costs& a, const Costs& b) {
    return a.values.back() / static_cast<double>(a.frames) > b.values.back() / static_cast<double>(b.frames);
  });
  std::size_t iterations = 0;
  for (const auto& c : all) iterations = std::max(iterations, c.iterations());
  Series median{"median state", {}, {}}, band{"middle 80 %", {}, {}, {}, true, false};
  for (std::size_t i = 0; i <= iterations; ++i) {
    std::vector<double> sorted;
    for (const auto& c : all) sorted.push_back(c.after(i));
    std::sort(sorted.begin(), sorted.end());
    const double low = quantile(sorted, 0.1), high = quantile(sorted, 0.9);
    median.x.push_back(static_cast<double>(i));
    median.y.push_back(quantile(sorted, 0.5));
    band.x.push_back(static_cast<double>(i));
    band.y.push_back((low + high) / 2);
    band.spread.push_back((high - low) / 2);
  }
  Panel panel{fmt::format("{} states", all.size()), "iteration", y_label, {median, band}};
  for (std::size_t i = 0; i < std::min(worst, all.size()); ++i)
    panel.series.push_back(curve(fmt::format("{} ({})", all[i].name, all[i].ended), all[i].iterations(),
                                 [&](std::size_t k) { return all[i].after(k); }));
  return panel;
}

Table table_of(const std::vector<Costs>& all) {
  struct Sum {
    double states = 0, iterations = 0, frames = 0;
  };
  std::map<std::string, Sum> reasons;
  for (const auto& c : all) {
    Sum& sum = reasons[c.ended];
    ++sum.states;
    sum.iterations += static_cast<double>(c.iterations());
    sum.frames += static_cast<double>(c.frames);
  }
  Table table{"Why training stopped", "reason", {"states", "iterations", "frames"}, {}, {}};
  for (const auto& [reason, sum] : reasons) {
    table.rows.push_back(reason);
    table.cells.push_back({sum.states, sum.iterations / sum.states, sum.frames / sum.states});
  }
  return table;
}

}  // namespace

PlotConvergence::Out PlotConvergence::operator()(const Value& model) const {
  auto all = costs_of(model, per_frame);
  const std::string y_label = per_frame ? "−ln p a frame" : "−ln p";
  Out out{{title, ""}, table_of(all)};
  if (std::ssize(all) <= panels)
    out.plot.svg = draw_panels(title, panel_each(all, y_label));
  else
    out.plot.svg =
        draw_panels(title, {panel_of_many(std::move(all), static_cast<std::size_t>(worst), y_label)}, {1, 860, 380});
  return out;
}

void describe(Description<PlotConvergence>& d) {
  d.type("plot.convergence")
      .version(1)
      .summary("how training lowered its cost, iteration by iteration, and why it stopped");
  d.input("model", "an Ssgpdm, an Sgpdm, a Gpdm or a GpRegression");
  d.output("plot", &PlotConvergence::Out::plot, "a panel a model; of many states median, band and worst");
  d.output("table", &PlotConvergence::Out::table, "a row a reason: states, their iterations and frames on average");
  d.param("per_frame", &PlotConvergence::per_frame).doc("the cost is divided by the frames trained on");
  d.param("panels", &PlotConvergence::panels).within(1, 60).doc("a model with more states is shown in one panel");
  d.param("worst", &PlotConvergence::worst).within(0, 5).doc("states shown by themselves there: highest costs a frame");
  d.param("title", &PlotConvergence::title).doc("heading");
}

}  // namespace talkgraph
