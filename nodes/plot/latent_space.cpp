#include "nodes/plot/latent_space.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>

#include "graph/json.h"
#include "nodes/latent/predictive.h"
#include "nodes/types/gpdm.h"
#include "nodes/types/ssgpdm.h"

namespace talkgraph {
namespace {

// Okabe and Ito's and, for the less frequent, Tol's.
constexpr std::array<const char*, 12> kPhoneColours = {"#d55e00", "#0072b2", "#009e73", "#cc79a7",
                                                       "#e69f00", "#56b4e9", "#332288", "#882255",
                                                       "#999933", "#44aa99", "#661100", "#222222"};
constexpr const char* kOthers = "#7f7f7f";

void add_dynamics(LatentSpace& space, const std::optional<GaussianProcess>& dynamics) {
  if (dynamics) space.dynamics = {"dynamics", &*dynamics};
}

LatentSpace space_of(const Sgpdm& s) {
  LatentSpace space{s.label, &s.latents, s.lengths, {{"audio", &s.audio}, {"visual", &s.visual}},
                    {},      &s.trace,   s.ended};
  add_dynamics(space, s.dynamics);
  return space;
}

LatentSpace space_of(const Gpdm& g) {
  LatentSpace space{"", &g.latents, g.lengths, {{"observations", &g.observations}}, {}, &g.trace, g.ended};
  add_dynamics(space, g.dynamics);
  return space;
}

double inverse_width(const KernelTerm& term, Eigen::Index dimension) {
  if (const auto* rbf = std::get_if<RbfTerm>(&term)) return rbf->variance * rbf->inverse_width;
  if (const auto* ard = std::get_if<ArdTerm>(&term)) return ard->variance * ard->inverse_widths[dimension];
  return 0;
}

std::vector<std::string> phones_of(const std::string& label) {
  std::vector<std::string> phones;
  for (std::size_t start = 0, dash = 0; dash != std::string::npos; start = dash + 1) {
    dash = label.find('-', start);
    phones.push_back(label.substr(start, dash - start));
  }
  return phones;
}

std::int64_t total(const std::vector<std::int64_t>& lengths) {
  return std::accumulate(lengths.begin(), lengths.end(), std::int64_t{0});
}

/// Whether each window has a sequence of labels, at most two longer.
bool fit_windows(const Collected<FrameLabels>& labels, const std::vector<std::int64_t>& lengths) {
  if (labels.size() != lengths.size()) return false;
  for (std::size_t w = 0; w < lengths.size(); ++w)
    if (const auto more = std::ssize(labels[w].labels) - lengths[w]; more < 0 || more > 2) return false;
  return true;
}

}  // namespace

std::vector<LatentSpace> latent_spaces(const Value& model) {
  std::vector<LatentSpace> spaces;
  const PortType type = model ? model.type().type : PortType{"nothing", 0};
  if (type == port_type<Ssgpdm>)
    for (const auto& [label, state] : model.get<Ssgpdm>().states) spaces.push_back(space_of(state));
  else if (type == port_type<Sgpdm>)
    spaces.push_back(space_of(model.get<Sgpdm>()));
  else if (type == port_type<Gpdm>)
    spaces.push_back(space_of(model.get<Gpdm>()));
  else
    throw std::runtime_error(
        fmt::format("{} has no latent space: wire a model of type Ssgpdm, Sgpdm or Gpdm", type.name));
  if (spaces.empty()) throw std::runtime_error("the switching model has no states; train it first");
  for (const auto& s : spaces)
    if (s.latents->size() == 0 || total(s.lengths) != s.latents->rows())
      throw std::runtime_error(fmt::format("state \"{}\" has {} latent points of {} dimensions in windows of {} frames",
                                           s.label, s.latents->rows(), s.latents->cols(), total(s.lengths)));
  return spaces;
}

LatentSpace latent_space(const Value& model, const std::string& state) {
  const auto spaces = latent_spaces(model);
  const auto weight = [](const LatentSpace& s) {
    return std::pair(s.label.find('-') != std::string::npos, s.latents->rows());
  };
  if (state.empty())
    return *std::max_element(spaces.begin(), spaces.end(),
                             [&](const auto& a, const auto& b) { return weight(a) < weight(b); });
  std::vector<std::string> labels;
  for (const auto& s : spaces) {
    if (s.label == state) return s;
    labels.push_back(s.label);
  }
  throw std::invalid_argument(
      fmt::format("there is no state \"{}\" among the model's {}{}; without `state` the one with most frames is shown",
                  state, spaces.size(), did_you_mean(state, labels)));
}

std::string heading_of(const LatentSpace& space) {
  const auto counted = [](std::int64_t n, const char* what) {
    return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
  };
  return fmt::format("{}{} in {}", space.label.empty() ? "" : space.label + ": ",
                     counted(space.latents->rows(), "frame"), counted(std::ssize(space.lengths), "window"));
}

LatentSpace::Process process_of(const LatentSpace& space, const std::string& name) {
  if (name.empty()) return space.observed.back();
  auto all = space.observed;
  if (space.dynamics) all.push_back(*space.dynamics);
  std::vector<std::string> names;
  for (const auto& p : all) {
    if (p.name == name) return p;
    names.push_back(p.name);
  }
  throw std::invalid_argument(fmt::format("the model{} has no process \"{}\"{}; it has {}",
                                          space.label.empty() ? "" : " of state \"" + space.label + "\"", name,
                                          did_you_mean(name, names), fmt::join(names, ", ")));
}

Eigen::VectorXd relevances(const LatentSpace& space) {
  const Eigen::MatrixXd centred = space.latents->rowwise() - space.latents->colwise().mean();
  const Eigen::VectorXd variances = centred.colwise().squaredNorm() / static_cast<double>(centred.rows());
  Eigen::VectorXd widths = Eigen::VectorXd::Zero(variances.size());
  for (const auto& p : space.observed)
    for (const auto& term : p.process->kernel.terms)
      for (Eigen::Index i = 0; i < widths.size(); ++i) widths[i] += inverse_width(term, i);
  return widths.maxCoeff() > 0 ? Eigen::VectorXd(variances.cwiseProduct(widths)) : variances;
}

std::string LatentAxis::name() const {
  return kind == Kind::dimension ? fmt::format("latent dimension {}", dimension + 1)
         : kind == Kind::frame   ? "frame of the window"
                                 : "";
}

std::vector<LatentAxis> latent_axes(const LatentSpace& space, const std::vector<int>& chosen, std::size_t count) {
  using Kind = LatentAxis::Kind;
  const Eigen::Index d = space.latents->cols();
  std::vector<LatentAxis> axes;
  for (const int c : chosen) {
    const auto same = [&](const LatentAxis& a) { return a.dimension + 1 == c; };
    if (c < 1 || c > d || std::any_of(axes.begin(), axes.end(), same))
      throw std::invalid_argument(
          fmt::format("latent dimensions {} cannot be drawn: choose {} different ones from 1 to {}, or none",
                      fmt::join(chosen, ", "), count, d));
    axes.push_back({Kind::dimension, c - 1});
  }
  if (!chosen.empty() && chosen.size() != count)
    throw std::invalid_argument(
        fmt::format("{} latent dimensions are chosen: choose {}, or none for the most relevant", chosen.size(), count));
  if (!chosen.empty()) return axes;
  const Eigen::VectorXd relevance = relevances(space);
  std::vector<Eigen::Index> order(static_cast<std::size_t>(d));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return relevance[a] > relevance[b]; });
  order.resize(std::min(order.size(), count));
  for (const Eigen::Index i : order) axes.push_back({Kind::dimension, i});
  if (axes.size() < count) axes.push_back({Kind::frame});
  axes.resize(count, {Kind::nothing});
  return axes;
}

Eigen::MatrixXd along(const std::vector<LatentAxis>& axes, const Eigen::MatrixXd& points,
                      const std::vector<std::int64_t>& frames) {
  Eigen::MatrixXd places = Eigen::MatrixXd::Zero(points.rows(), std::ssize(axes));
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const auto column = static_cast<Eigen::Index>(a);
    if (axes[a].kind == LatentAxis::Kind::dimension) places.col(column) = points.col(axes[a].dimension);
    if (axes[a].kind == LatentAxis::Kind::frame)
      for (Eigen::Index t = 0; t < points.rows(); ++t)
        places(t, column) = static_cast<double>(frames[static_cast<std::size_t>(t)]);
  }
  return places;
}

std::vector<std::int64_t> frames_in_windows(const std::vector<std::int64_t>& lengths) {
  std::vector<std::int64_t> frames;
  for (const auto length : lengths)
    for (std::int64_t t = 0; t < length; ++t) frames.push_back(t);
  return frames;
}

Eigen::MatrixXd latents_at(const LatentSpace& space, const std::vector<LatentAxis>& axes,
                           const Eigen::MatrixXd& places) {
  Eigen::MatrixXd x = space.latents->colwise().mean().replicate(places.rows(), 1);
  for (std::size_t a = 0; a < axes.size(); ++a)
    if (axes[a].kind == LatentAxis::Kind::dimension)
      x.col(axes[a].dimension) = places.col(static_cast<Eigen::Index>(a));
  return x;
}

Eigen::VectorXd log_precision(const GaussianProcess& process, const Eigen::MatrixXd& x) {
  Predictive predictive;
  predictive.compute(process, x);
  return -predictive.variance().array().max(std::numeric_limits<double>::min()).log();
}

std::vector<std::string> latent_phones(const LatentSpace& space, const Collected<FrameLabels>& labels) {
  std::vector<std::string> phones;
  if (labels.empty()) {
    const auto named = phones_of(space.label);
    for (const auto length : space.lengths) {
      if (length == std::ssize(named))
        phones.insert(phones.end(), named.begin(), named.end());
      else
        phones.insert(phones.end(), static_cast<std::size_t>(length), space.label);
    }
    return phones;
  }
  const bool by_window = fit_windows(labels, space.lengths);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const auto& all = labels[i].labels;
    phones.insert(phones.end(), all.begin(), by_window ? all.begin() + space.lengths[i] : all.end());
  }
  if (std::ssize(phones) != space.latents->rows())
    throw std::runtime_error(fmt::format(
        "{} labels for {} latent points: wire the labels of the sequences that the model was trained on, if it was "
        "trained on all their frames; a state of a switching model needs none",
        phones.size(), space.latents->rows()));
  return phones;
}

std::vector<Eigen::MatrixXd> paths_within(const LatentSpace& space, const Collected<Track>& paths,
                                          const Collected<SegmentTrack>& segments) {
  std::vector<Eigen::MatrixXd> parts;
  const Eigen::Index d = space.latents->cols();
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const Track& path = paths[i];
    if (path.frames() > 0 && path.dimension() < d)
      throw std::runtime_error(
          fmt::format("path \"{}\" has {} dimensions, the latent space {}", paths.key(i), path.dimension(), d));
    const SegmentTrack* of_path = segments.find(paths.key(i));
    if (space.label.empty() || !of_path) {
      if (path.frames() > 0 && (space.label.empty() || segments.empty())) parts.push_back(path.values.leftCols(d));
      continue;
    }
    for (const auto& s : of_path->segments) {
      if (s.start < 0 || s.start + s.length > path.frames())
        throw std::runtime_error(fmt::format("path \"{}\" has {} frames, but a segment of frames {} to {}",
                                             paths.key(i), path.frames(), s.start, s.start + s.length - 1));
      if (s.label == space.label && s.length > 0) parts.push_back(path.values.block(s.start, 0, s.length, d));
    }
  }
  return parts;
}

PhoneColours phone_colours(const std::vector<std::string>& phones) {
  std::map<std::string, std::int64_t> counts;
  for (const auto& p : phones) ++counts[p];
  std::vector<std::pair<std::string, std::int64_t>> order(counts.begin(), counts.end());
  std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  const std::size_t own = std::min(order.size(), kPhoneColours.size());
  PhoneColours out;
  std::map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < order.size(); ++i) {
    index[order[i].first] = std::min(i, own);
    if (i < own) {
      out.names.push_back(order[i].first);
      out.colours.emplace_back(kPhoneColours[i]);
      out.counts.push_back(order[i].second);
    } else if (i == own) {
      out.names.push_back(order.size() - own == 1 ? order[i].first : fmt::format("{} others", order.size() - own));
      out.colours.emplace_back(kOthers);
      out.counts.push_back(order[i].second);
    } else {
      out.counts.back() += order[i].second;
    }
  }
  for (const auto& p : phones) out.of_frame.push_back(index.at(p));
  return out;
}

}  // namespace talkgraph
