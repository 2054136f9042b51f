#include "nodes/mapping/context_gp_inspect.h"

#include <algorithm>
#include <numeric>

namespace talkgraph {
namespace {

Table costs_of_phones(const ContextGp& model) {
  const Eigen::MatrixXd map = model.map.middleRows(model.audio_mean.size(), std::ssize(model.phones));
  const double weight = model.window.sum();
  struct Pair {
    double cost;
    std::string phones;
  };
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < model.phones.size(); ++a)
    for (std::size_t b = a + 1; b < model.phones.size(); ++b)
      pairs.push_back(
          {weight * (map.row(static_cast<Eigen::Index>(a)) - map.row(static_cast<Eigen::Index>(b))).squaredNorm(),
           model.phones[a] + " - " + model.phones[b]});
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.cost < b.cost; });
  Table table{"What it costs soft contexts to take one phone for another", "phones", {"cost"}, {}, {}};
  for (const auto& [cost, phones] : pairs) {
    table.rows.push_back(phones);
    table.cells.push_back({cost});
  }
  return table;
}

Table costs_of_sound(const ContextGp& model) {
  Table table{"What a deviation of the sound costs soft contexts", "dimension", {"cost"}, {}, {}};
  for (Eigen::Index i = 0; i < model.audio_mean.size(); ++i) {
    table.rows.push_back(std::to_string(i + 1));
    table.cells.push_back({model.window.sum() * model.map.row(i).squaredNorm()});
  }
  return table;
}

Table costs_of_place(const ContextGp& model) {
  Table table{"What places in the recording cost soft contexts", "place", {"cost"}, {}, {}};
  if (model.place_time == 0) return table;
  table.rows = {"its start", "the end of speech"};
  for (const auto& row : model.map.bottomRows(2).rowwise())
    table.cells.push_back({model.window.sum() * row.squaredNorm()});
  return table;
}

Table weights_of_window(const ContextGp& model) {
  Table table{"What soft contexts look at", "frame", {"weight"}, {}, {}};
  for (Eigen::Index l = 0; l < model.window.size(); ++l) {
    table.rows.push_back(std::to_string(l - model.window.size() / 2));
    table.cells.push_back({model.window[l]});
  }
  return table;
}

}  // namespace

InspectContextGp::Tables InspectContextGp::operator()(const ContextGp& model) const {
  return {costs_of_phones(model), costs_of_sound(model), costs_of_place(model), weights_of_window(model)};
}

void describe(Description<InspectContextGp>& d) {
  d.type("mapping.context_gp_inspect")
      .summary("which phones soft contexts hold alike, and how much sound, place and neighbours count");
  d.input("model", "of mapping.context_gp")
      .output("phones", &InspectContextGp::Tables::phones, "a row a pair of phones, the most alike first")
      .output("sound", &InspectContextGp::Tables::sound, "a row a dimension of the sound")
      .output("place", &InspectContextGp::Tables::place, "a row a place; none if places are not compared")
      .output("window", &InspectContextGp::Tables::window, "a row a neighbour");
}

}  // namespace talkgraph
