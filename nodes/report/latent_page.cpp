#include "nodes/report/latent_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "graph/json.h"
#include "graph/output_file.h"
#include "nodes/plot/svg.h"
#include "nodes/report/page.h"
#include "nodes/types/item_file.h"

namespace talkgraph {
namespace {

constexpr std::string_view kPage =
#include "report/latent.html.inc"
    ;
constexpr std::string_view kStyle =
#include "report/latent.css.inc"
    ;
constexpr std::string_view kScript =
#include "report/latent.js.inc"
    ;

struct Scene {
  std::vector<LatentAxis> axes;
  Eigen::MatrixXd points;              ///< N × 3
  std::vector<Eigen::MatrixXd> paths;  ///< T × 3
  Eigen::RowVector3d low, high;        ///< of the box
  std::vector<std::string> said;       ///< at every point
  Eigen::VectorXd precision, cloud;    ///< ln 1/σ² at points; in the box, the first axis fastest
  PhoneColours phones;
};

/// Around all points with a margin; an axis without extent gets the size of the largest.
void set_box(Scene& scene) {
  scene.low = scene.points.colwise().minCoeff(), scene.high = scene.points.colwise().maxCoeff();
  for (const auto& path : scene.paths) {
    scene.low = scene.low.cwiseMin(path.colwise().minCoeff());
    scene.high = scene.high.cwiseMax(path.colwise().maxCoeff());
  }
  const Eigen::RowVector3d size = scene.high - scene.low;
  const double largest = size.maxCoeff() > 0 ? size.maxCoeff() : 1;
  for (Eigen::Index a = 0; a < 3; ++a) {
    const double margin = size[a] > 0 ? 0.12 * size[a] : 0.5 * largest;
    scene.low[a] -= margin, scene.high[a] += margin;
  }
}

Eigen::VectorXd cloud_of(const Scene& scene, const LatentSpace& space, const GaussianProcess& process, Eigen::Index n) {
  const Eigen::ArrayXd shares = (Eigen::ArrayXd::LinSpaced(n, 0, static_cast<double>(n - 1)) + 0.5) / n;
  const auto along_axis = [&](Eigen::Index a) -> Eigen::ArrayXd {
    return scene.low[a] + shares * (scene.high[a] - scene.low[a]);
  };
  Eigen::VectorXd cloud(n * n * n);
  Eigen::MatrixXd places(n * n, 3);
  places.col(0) = along_axis(0).replicate(n, 1);
  for (Eigen::Index j = 0; j < n; ++j) places.col(1).segment(j * n, n).setConstant(along_axis(1)[j]);
  for (Eigen::Index k = 0; k < n; ++k) {
    places.col(2).setConstant(along_axis(2)[k]);
    cloud.segment(k * n * n, n * n) = log_precision(process, latents_at(space, scene.axes, places));
  }
  return cloud;
}

/// To a ten-thousandth of the box: what a screen shows.
Json rounded(const Eigen::MatrixXd& rows, double size) {
  const double unit = std::pow(10, std::floor(std::log10(size)) - 4);
  Json out = Json::array();
  for (const auto& row : rows.rowwise()) {
    Json point = Json::array();
    for (const double v : row) point.push_back(std::round(v / unit) * unit);
    out.push_back(std::move(point));
  }
  return out;
}

Json data_of(const Scene& scene, const LatentSpace& space, int resolution) {
  const double size = (scene.high - scene.low).maxCoeff();
  const double least = scene.cloud.minCoeff(), surest = std::max(scene.cloud.maxCoeff(), scene.precision.maxCoeff());
  Json data = {{"lengths", space.lengths},
               {"points", rounded(scene.points, size)},
               {"phone", scene.phones.of_frame},
               {"low", std::vector<double>(scene.low.begin(), scene.low.end())},
               {"high", std::vector<double>(scene.high.begin(), scene.high.end())},
               {"resolution", resolution},
               {"least", least},
               {"surest", surest}};
  for (const auto& axis : scene.axes) data["axes"].push_back(axis.name());
  data["paths"] = Json::array();
  for (const auto& path : scene.paths) data["paths"].push_back(rounded(path, size));
  for (std::size_t i = 0; i < scene.phones.names.size(); ++i)
    data["phones"].push_back(
        {{"name", scene.phones.names[i]}, {"colour", scene.phones.colours[i]}, {"count", scene.phones.counts[i]}});
  std::map<std::string, std::size_t> labels;
  for (const auto& said : scene.said) {
    const auto [label, fresh] = labels.emplace(said, labels.size());
    if (fresh) data["labels"].push_back(said);
    data["label"].push_back(label->second);
  }
  for (const double v : scene.precision) data["precision"].push_back(std::round(v * 1000) / 1000);
  for (const double v : scene.cloud)
    data["cloud"].push_back(surest > least ? std::lround(255 * (v - least) / (surest - least)) : 255);
  return data;
}

/// What is said, with its frames, its mean place and mean precision.
Table table_of(const Scene& scene) {
  Table table{"", "said", {"frames"}, {}, {}};
  std::vector<Eigen::Index> drawn;
  for (std::size_t a = 0; a < 3; ++a) {
    if (scene.axes[a].kind == LatentAxis::Kind::nothing) continue;
    drawn.push_back(static_cast<Eigen::Index>(a));
    table.columns.push_back("mean " + scene.axes[a].name());
  }
  table.columns.push_back("mean ln precision");
  for (std::size_t i = 0; i < scene.phones.names.size(); ++i) {
    std::vector<Eigen::Index> of;
    for (std::size_t t = 0; t < scene.phones.of_frame.size(); ++t)
      if (scene.phones.of_frame[t] == i) of.push_back(static_cast<Eigen::Index>(t));
    std::vector<double> cells = {static_cast<double>(of.size())};
    for (const auto a : drawn) cells.push_back(scene.points(of, a).mean());
    cells.push_back(scene.precision(of).mean());
    table.rows.push_back(scene.phones.names[i]);
    table.cells.push_back(std::move(cells));
  }
  return table;
}

std::string summary_of(const Scene& scene, const LatentSpace& space, const std::string& process) {
  std::string out =
      fmt::format("Latent points of {}; phones {}.", heading_of(space), fmt::join(scene.phones.names, ", "));
  if (!scene.paths.empty()) out += fmt::format(" {} synthesised paths.", scene.paths.size());
  return out + fmt::format(
                   " The natural logarithm of the predictive precision of the {} process lies between {:.2f} and "
                   "{:.2f} at the points.",
                   process, scene.precision.minCoeff(), scene.precision.maxCoeff());
}

/// JSON that no label can lead out of its element.
std::string script_safe(const Json& json) {
  std::string out;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace))
    out += c == '<' ? "\\u003c" : std::string(1, c);
  return out;
}

/// The page with every {{name}} put in place, once: what is put in is not looked at again.
std::string filled(const std::map<std::string_view, std::string>& parts) {
  std::string out;
  std::string_view rest = kPage;
  for (std::size_t at; (at = rest.find("{{")) != std::string_view::npos;) {
    const auto end = rest.find("}}", at);
    out += rest.substr(0, at);
    out += parts.at(rest.substr(at + 2, end - at - 2));
    rest.remove_prefix(end + 2);
  }
  return out += rest;
}

}  // namespace

Artifact LatentPage::operator()(const Value& model, const Collected<FrameLabels>& labels, const Collected<Track>& paths,
                                const Collected<SegmentTrack>& states, Context& context) const {
  const LatentSpace space = latent_space(model, state);
  const auto of = process_of(space, process);
  Scene scene;
  scene.axes = latent_axes(space, dimensions, 3);
  scene.points = along(scene.axes, *space.latents, frames_in_windows(space.lengths));
  for (const auto& path : paths_within(space, paths, states))
    scene.paths.push_back(along(scene.axes, path, frames_in_windows({path.rows()})));
  set_box(scene);
  scene.said = latent_phones(space, labels);
  scene.phones = phone_colours(scene.said);
  scene.precision = log_precision(*of.process, *space.latents);
  scene.cloud = cloud_of(scene, space, *of.process, resolution);

  const std::string heading = title.empty() ? heading_of(space) : title;
  const Artifact file = item_file(context, "", ".html", name);
  write_file(context.file(file.path), filled({{"title", escape_markup(heading)},
                                              {"style", std::string(kStyle)},
                                              {"script", std::string(kScript)},
                                              {"summary", escape_markup(summary_of(scene, space, of.name))},
                                              {"table", html_table("What is said", table_of(scene))},
                                              {"data", script_safe(data_of(scene, space, resolution))}}));
  return {file.path, heading};
}

void describe(Description<LatentPage>& d) {
  d.type("report.latent").version(2).sink();
  d.summary("writes a page to turn and zoom a model's latent space in, in three dimensions");
  d.source("Thesis §5.2.3, Figures 5.9 to 5.12");
  d.input("model", "an Ssgpdm, of which one state is shown, an Sgpdm or a Gpdm")
      .input("labels",
             "phones or visemes of the frames trained on; {} for a state of a switching model, which has its own")
      .input("paths", "synthesised latent points, drawn as well: latents of mapping.ssgpdm_synthesise, or {}")
      .input("states", "whose segments the paths are: states of mapping.ssgpdm_synthesise, or {}")
      .output("file", "the page");
  d.param("state", &LatentPage::state)
      .doc("label of the state; empty: the one with most frames, if possible of several phones");
  d.param("process", &LatentPage::process)
      .doc("whose precision is the cloud: audio, visual, observations or dynamics; empty: the last one observed");
  d.param("dimensions", &LatentPage::dimensions).at_least(1).doc("three, from 1; empty: the most relevant three");
  d.param("resolution", &LatentPage::resolution).within(4, 48).doc("places of the cloud along each axis");
  d.param("title", &LatentPage::title).doc("heading; empty: the state's label and size");
  d.param("name", &LatentPage::name).doc("of the file, without its ending; of the item in a stream");
}

}  // namespace talkgraph
