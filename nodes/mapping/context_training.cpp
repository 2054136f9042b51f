#include "nodes/mapping/context_training.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "nodes/mapping/context_frames.h"
#include "nodes/mapping/phone_inventory.h"

namespace talkgraph {
namespace {

using Utterances = std::vector<ContextUtterance>;

/// Mean of the audio features, and 1 / deviation, 0 where only rounding varies.
void z_score(const Utterances& utterances, ContextGp& model) {
  const auto dimension = utterances[0].audio->dimension();
  double n = 0;
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(dimension), squares = sum;
  for (const auto& u : utterances) {
    sum += u.audio->values.topRows(u.frames).colwise().sum();
    n += static_cast<double>(u.frames);
  }
  model.audio_mean = sum / std::max(n, 1.0);
  for (const auto& u : utterances)
    squares += (u.audio->values.topRows(u.frames).rowwise() - model.audio_mean).colwise().squaredNorm();
  const Eigen::RowVectorXd deviation = (squares / std::max(n, 1.0)).cwiseSqrt();
  model.audio_scale =
      (deviation.array() > 1e-10 * model.audio_mean.array().abs()).select(deviation.cwiseInverse(), 0.0);
}

std::vector<std::string> phones_of(const Utterances& utterances) {
  std::vector<std::string> labels;
  for (const auto& u : utterances)
    for (const auto& phone : u.phones->phones) labels.push_back(phone.label);
  return phone_inventory(std::move(labels));
}

Eigen::RowVectorXd window_of(int reach, double width) {
  Eigen::RowVectorXd w(2 * reach + 1);
  for (int l = -reach; l <= reach; ++l) w[l + reach] = std::exp(-std::pow(l / width, 2));
  return w / w.sum();
}

void set_kernel(const TrainContextGp& node, ContextGp& model) {
  const auto heard = model.audio_mean.size(), said = std::ssize(model.phones);
  model.place_time = node.place > 0 ? node.place_time : 0;
  const Eigen::Index placed = node.place > 0 ? 2 : 0;
  Eigen::VectorXd costs(heard + said + placed);
  costs << Eigen::VectorXd::Constant(heard, 0.5 * node.sound / static_cast<double>(heard)),
      Eigen::VectorXd::Constant(said, 0.5 * node.phones), Eigen::VectorXd::Constant(placed, node.place);
  model.map = costs.cwiseSqrt().asDiagonal();
  model.window = window_of(node.reach, node.width);
  model.noise = node.noise;
}

void describe_frames(const Utterances& utterances, ContextGp& model) {
  Eigen::Index total = 0;
  for (const auto& u : utterances) total += u.frames;
  model.frames.resize(total, model.map.cols());
  Eigen::Index at = 0;
  for (const auto& u : utterances) {
    model.frames.middleRows(at, u.frames) = context_frames(model, *u.audio, *u.phones, u.frames);
    model.lengths.push_back(u.frames);
    at += u.frames;
  }
}

std::vector<Eigen::Index> frames_to_learn(const TrainContextGp& node, const Utterances& utterances) {
  std::vector<Eigen::Index> rows;
  Eigen::Index start = 0;
  for (const auto& u : utterances) {
    const auto near = near_speech(u, node.margin);
    for (Eigen::Index t = 0; t < u.frames; ++t)
      if (!u.visual->is_lost(t) && (near[static_cast<std::size_t>(t)] || t % node.pauses == 0))
        rows.push_back(start + t);
    start += u.frames;
  }
  if (rows.empty()) throw std::runtime_error("no training frame was measured: are all lost?");
  return thinned(rows, node.max_frames);
}

Eigen::MatrixXd visual_frames(const Utterances& utterances, Eigen::Index total) {
  Eigen::MatrixXd z(total, utterances[0].visual->dimension());
  Eigen::Index at = 0;
  for (const auto& u : utterances) {
    z.middleRows(at, u.frames) = u.visual->values.topRows(u.frames);
    at += u.frames;
  }
  return z;
}

}  // namespace

ContextTraining context_training(const TrainContextGp& node, const Collected<Track>& audio,
                                 const Collected<PhoneTrack>& phones, const Collected<Track>& visual) {
  ContextTraining t{{}, context_utterances(audio, phones, visual), {}, {}};
  z_score(t.utterances, t.model);
  t.model.phones = phones_of(t.utterances);
  set_kernel(node, t.model);
  describe_frames(t.utterances, t.model);
  t.rows = frames_to_learn(node, t.utterances);
  t.targets = visual_frames(t.utterances, t.model.frames.rows())(t.rows, Eigen::all);
  t.model.mean = t.targets.colwise().mean();
  t.targets.rowwise() -= t.model.mean;
  return t;
}

std::vector<Eigen::Index> thinned(const std::vector<Eigen::Index>& rows, int most) {
  const auto size = static_cast<std::size_t>(most);
  if (rows.size() <= size) return rows;
  std::vector<Eigen::Index> kept(size);
  for (std::size_t i = 0; i < size; ++i) kept[i] = rows[i * rows.size() / size];
  return kept;
}

}  // namespace talkgraph
