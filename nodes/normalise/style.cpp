#include "nodes/normalise/style.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "nodes/evaluate/explained.h"

namespace talkgraph {
namespace {

constexpr int parts = 5;       ///< that frames are cut into to explain each from the rest
constexpr double ridge = 0.1;  ///< penalty of the regressions: some 150 numbers of sound say what is true of few frames

/// Least share that the sound explains of the component that it explains best: of speakers 0.5 to 0.6; of noise, 20
/// components over 900 frames and more, 0.000 whether it changes slowly or fast (300 slow frames: 0.12 at worst).
constexpr double least_heard = 0.05;

Collected<Track> components_of(const IndependentComponents& components, const Collected<Track>& tracks) {
  Collected<Track> out;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    Track u = tracks[i];
    u.values = components.of(tracks[i].values);
    u.names.clear();
    out.add(tracks.key(i), std::move(u));
  }
  return out;
}

/// Every frame with `context` neighbours on both sides, the ends held.
Collected<Track> with_neighbours(const Collected<Track>& tracks, int context) {
  Collected<Track> out;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const auto frames = tracks[i].frames(), width = tracks[i].dimension();
    Track wide = tracks[i];
    wide.names.clear();
    wide.values.resize(frames, (2 * context + 1) * width);
    for (Eigen::Index t = 0; t < frames; ++t)
      for (Eigen::Index shift = -context; shift <= context; ++shift)
        wide.values.block(t, (shift + context) * width, 1, width) =
            tracks[i].values.row(std::clamp<Eigen::Index>(t + shift, 0, frames - 1));
    out.add(tracks.key(i), std::move(wide));
  }
  return out;
}

Collected<Track> poses_of(const Collected<FaceTrack>& faces) {
  Collected<Track> out;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    Track track;
    track.values.resize(std::ssize(faces[i].poses), 4);
    for (std::size_t t = 0; t < faces[i].poses.size(); ++t) {
      const auto& p = faces[i].poses[t];
      track.values.row(static_cast<Eigen::Index>(t)) << std::log(p.scale), p.angle, p.dx, p.dy;
      if (t < faces[i].lost.size() && faces[i].lost[t]) track.lost.push_back(static_cast<std::int64_t>(t));
    }
    out.add(faces.key(i), std::move(track));
  }
  return out;
}

/// Each column of deviation 1, or 0 where it does not vary.
Eigen::MatrixXd scaled(const Eigen::MatrixXd& rows) {
  const Eigen::MatrixXd x = rows.rowwise() - rows.colwise().mean();
  const Eigen::RowVectorXd deviation = (x.colwise().squaredNorm() / static_cast<double>(x.rows())).cwiseSqrt();
  return x * (deviation.array() > 1e-10 * deviation.maxCoeff()).select(1 / deviation.array(), 0).matrix().asDiagonal();
}

Eigen::RowVectorXd explained_by(const Collected<Track>& u, const Collected<Track>& by) {
  const auto rows = paired_rows(u, by);
  return explained_share(rows.truth, scaled(rows.by), parts, ridge);
}

/// Root mean square step between neighbouring frames that are both measured.
Eigen::RowVectorXd speed_of(const Collected<Track>& u) {
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(u[0].dimension());
  Eigen::Index count = 0;
  for (std::size_t i = 0; i < u.size(); ++i)
    for (Eigen::Index t = 1; t < u[i].frames(); ++t) {
      if (u[i].is_lost(t) || u[i].is_lost(t - 1)) continue;
      sum += (u[i].values.row(t) - u[i].values.row(t - 1)).cwiseAbs2();
      ++count;
    }
  return (sum / static_cast<double>(std::max<Eigen::Index>(count, 1))).cwiseSqrt();
}

/// Values as a share of the largest.
Eigen::RowVectorXd relative(const Eigen::RowVectorXd& values) {
  const double largest = values.maxCoeff();
  return largest > 0 ? Eigen::RowVectorXd(values / largest) : Eigen::RowVectorXd::Zero(values.size());
}

std::vector<bool> chosen_by_number(const std::vector<int>& style, Eigen::Index count) {
  std::vector<bool> out(static_cast<std::size_t>(count), false);
  for (const int number : style) {
    if (number < 1 || number > count)
      throw std::runtime_error(fmt::format("there is no component {}: they are numbered from 1 to {}", number, count));
    out[static_cast<std::size_t>(number - 1)] = true;
  }
  return out;
}

std::vector<bool> chosen_by_ranking(const Table& ranking, double above, Eigen::Index count) {
  const auto column = std::find(ranking.columns.begin(), ranking.columns.end(), "style") - ranking.columns.begin();
  if (column == std::ssize(ranking.columns) || std::ssize(ranking.rows) != count)
    throw std::runtime_error(fmt::format(
        "a ranking of {} components, with a column \"style\", is needed: that of normalise.rank_style", count));
  std::vector<int> style;
  for (std::size_t r = 0; r < ranking.rows.size(); ++r)
    if (ranking.cells[r][static_cast<std::size_t>(column)] >= above) style.push_back(std::stoi(ranking.rows[r]));
  if (std::ssize(style) == count)
    throw std::runtime_error(
        fmt::format("the ranking calls all {} components style, which leaves no speech: set \"above\" higher", count));
  return chosen_by_number(style, count);
}

}  // namespace

Table RankStyle::operator()(const IndependentComponents& components, const Collected<Track>& tracks,
                            const Collected<Track>& sound, const Collected<FaceTrack>& faces) const {
  if (by == StyleSign::pose && faces.empty()) throw std::runtime_error("a ranking by pose needs face tracks");
  const auto count = components.count();
  const auto u = components_of(components, tracks);
  const auto heard = explained_by(u, with_neighbours(sound, context));
  if (by == StyleSign::sound && !(heard.maxCoeff() >= least_heard))
    throw std::runtime_error(
        fmt::format("the sound explains {:.1f} % at most of any component, too little to tell style from speech: are "
                    "sound and pictures of the same clips and in time? \"by\": \"speed\" or \"pose\" ranks without it",
                    100 * heard.maxCoeff()));
  const auto speed = speed_of(u);
  const Eigen::RowVectorXd pose =
      faces.empty() ? Eigen::RowVectorXd::Constant(count, NAN) : explained_by(u, poses_of(faces));
  const Eigen::RowVectorXd variance = components.mixing.colwise().squaredNorm();
  const Eigen::RowVectorXd style = by == StyleSign::pose    ? relative(pose)
                                   : by == StyleSign::speed ? Eigen::RowVectorXd(1 - relative(speed).array())
                                                            : Eigen::RowVectorXd(1 - relative(heard).array());
  std::vector<Eigen::Index> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return style(a) > style(b); });
  Table table{"Independent components, what is style first",
              "component",
              {"style", "variance", "sound", "speed", "pose"},
              {},
              {}};
  for (const auto k : order) {
    table.rows.push_back(std::to_string(k + 1));
    table.cells.push_back({style(k), variance(k) / variance.sum(), heard(k), speed(k), pose(k)});
  }
  return table;
}

RemoveStyle::Out RemoveStyle::operator()(const IndependentComponents& components, const Track& track,
                                         const Table* ranking) const {
  if (!track.values.allFinite()) throw std::runtime_error("a track with NaN or infinite values has no components");
  const auto is_style = style.empty() && ranking ? chosen_by_ranking(*ranking, above, components.count())
                                                 : chosen_by_number(style, components.count());
  Eigen::MatrixXd u = components.of(track.values);
  for (Eigen::Index k = 0; k < u.cols(); ++k)
    if (is_style[static_cast<std::size_t>(k)]) u.col(k).setZero();
  Out out{track, track};
  out.normalised.values = u * components.mixing.transpose();
  out.style.values -= out.normalised.values;
  return out;
}

void describe(Description<RankStyle>& d) {
  d.type("normalise.rank_style")
      .version(1)
      .summary("ranks independent components: what does not follow the speech is style")
      .source("Thesis §3.4.1 leaves the choice to the eye");
  d.input("components", "of normalise.ica")
      .input("tracks", "that they are of")
      .input("sound", "speech features at the video rate, of the same clips")
      .input("faces", "face tracks of the same clips, for the head's pose; an empty object leaves it out")
      .output("ranking", "a row a component, the likeliest style first: style, variance, sound, speed, pose");
  d.param("by", &RankStyle::by)
      .doc(
          "what makes a component style: that the sound does not explain it, that it is slow, or that the head's pose "
          "explains it");
  d.param("context", &RankStyle::context).within(0, 50).unit("frames").doc("neighbours of the sound on each side");
}

void describe(Description<RemoveStyle>& d) {
  d.type("normalise.remove_style")
      .version(1)
      .summary("takes style off a track: style components set to zero")
      .source("Thesis §3.4.1, Eqns 3.37, 3.38");
  d.input("components", "of normalise.ica")
      .input("track", "of the dimensions they were learnt from")
      .input("ranking", "of normalise.rank_style, for `above`")
      .output("normalised", &RemoveStyle::Out::normalised, "speech: A u of the other components")
      .output("style", &RemoveStyle::Out::style,
              "what was taken off: training mean, style of each frame, what no component has");
  d.param("style", &RemoveStyle::style).doc("numbers of the style components, from 1; empty: by the ranking, or none");
  d.param("above", &RemoveStyle::above).within(0, 2).doc("of a ranking: least \"style\" that is taken off");
}

}  // namespace talkgraph
