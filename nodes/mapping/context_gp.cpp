#include "nodes/mapping/context_gp.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>

#include "nodes/mapping/context_kernel.h"
#include "nodes/types/visemes.h"

namespace talkgraph {
namespace {

/// One utterance of which all that training needs is known.
struct Utterance {
  std::string key;
  const Track* audio;
  const PhoneTrack* phones;
  const Track* visual;
  Eigen::Index frames;
};

std::vector<Utterance> pair_up(const Collected<Track>& audio, const Collected<PhoneTrack>& phones,
                               const Collected<Track>& visual) {
  std::vector<Utterance> utterances;
  for (std::size_t i = 0; i < audio.size(); ++i) {
    const auto& key = audio.key(i);
    const Utterance u{key, &audio[i], phones.find(key), visual.find(key), 0};
    if (!u.phones || !u.visual) continue;
    if (std::abs(u.audio->frames() - u.visual->frames()) > 2)
      throw std::runtime_error(fmt::format("{}: {} audio frames, {} visual frames; bring both to one rate", key,
                                           u.audio->frames(), u.visual->frames()));
    if (!u.audio->values.allFinite() || !u.visual->values.allFinite())
      throw std::runtime_error(key + ": NaN or infinite values");
    utterances.push_back(u);
    utterances.back().frames = std::min(u.audio->frames(), u.visual->frames());
    if (u.audio->dimension() != utterances[0].audio->dimension() ||
        u.visual->dimension() != utterances[0].visual->dimension())
      throw std::runtime_error(key + ": other dimensions than the tracks before");
  }
  if (utterances.empty())
    throw std::runtime_error("no training utterance has sound, phones and face: is the selection empty?");
  return utterances;
}

std::vector<std::string> inventory(const std::vector<Utterance>& utterances) {
  std::set<std::string> met;
  for (const auto& u : utterances)
    for (const auto& phone : u.phones->phones) met.insert(phone.label);
  return {met.begin(), met.end()};
}

/// Mean of the audio features, and 1 / deviation, 0 where only rounding varies.
void z_score(const std::vector<Utterance>& utterances, ContextGp& model) {
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

Eigen::RowVectorXd window_of(int reach, double width) {
  Eigen::RowVectorXd w(2 * reach + 1);
  for (int l = -reach; l <= reach; ++l) w[l + reach] = std::exp(-std::pow(l / width, 2));
  return w / w.sum();
}

/// What the kernel compares, a row a frame.
Eigen::MatrixXd described(const ContextGp& model, const Track& audio, const PhoneTrack& phones, Eigen::Index frames) {
  Eigen::MatrixXd f(frames, model.audio_mean.size() + static_cast<Eigen::Index>(model.phones.size()));
  f.leftCols(model.audio_mean.size()) =
      (audio.values.topRows(frames).rowwise() - model.audio_mean).array().rowwise() * model.audio_scale.array();
  f.rightCols(static_cast<Eigen::Index>(model.phones.size())) =
      phone_shares(phones, model.phones, audio).topRows(frames);
  return f * model.map;
}

/// Kernel of some frames of one utterance (rows) with all of another.
Eigen::MatrixXd kernel(const Eigen::RowVectorXd& window, const Eigen::MatrixXd& a, const std::vector<Eigen::Index>& of,
                       const Eigen::MatrixXd& b) {
  Eigen::MatrixXd distance = -2 * a * b.transpose();
  distance.colwise() += a.rowwise().squaredNorm();
  distance.rowwise() += b.rowwise().squaredNorm().transpose();
  const Eigen::Index n = window.size() / 2;
  Eigen::MatrixXd exponent = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(of.size()), b.rows());
  for (Eigen::Index l = -n; l <= n; ++l)
    for (Eigen::Index j = 0; j < b.rows(); ++j) {
      const auto column = distance.col(std::clamp<Eigen::Index>(j + l, 0, b.rows() - 1));
      for (Eigen::Index i = 0; i < exponent.rows(); ++i)
        exponent(i, j) +=
            window[l + n] * column[std::clamp<Eigen::Index>(of[static_cast<std::size_t>(i)] + l, 0, a.rows() - 1)];
    }
  return (-exponent.cwiseMax(0)).array().exp();
}

/// Whether each frame is in speech or at most `margin` frames from it.
std::vector<bool> near_speech(const PhoneTrack& phones, const Track& like, Eigen::Index frames, int margin) {
  const double reach = (0.5 + margin) / like.rate.value();
  std::vector<bool> near(static_cast<std::size_t>(frames));
  for (const auto& phone : phones.phones) {
    if (is_pause(phone.label)) continue;
    for (Eigen::Index t = 0; t < frames; ++t)
      if (like.time(t) > phone.start - reach && like.time(t) < phone.end + reach)
        near[static_cast<std::size_t>(t)] = true;
  }
  return near;
}

/// These, or `most` of them at even distances.
std::vector<Eigen::Index> thinned(const std::vector<Eigen::Index>& rows, std::size_t most) {
  if (rows.size() <= most) return rows;
  std::vector<Eigen::Index> kept(most);
  for (std::size_t i = 0; i < most; ++i) kept[i] = rows[i * rows.size() / most];
  return kept;
}

std::vector<Eigen::Index> chosen(const TrainContextGp& node, const std::vector<Utterance>& utterances) {
  std::vector<Eigen::Index> rows;
  Eigen::Index start = 0;
  for (const auto& u : utterances) {
    const auto near = near_speech(*u.phones, *u.audio, u.frames, node.margin);
    for (Eigen::Index t = 0; t < u.frames; ++t)
      if (!u.visual->is_lost(t) && (near[static_cast<std::size_t>(t)] || t % node.pauses == 0))
        rows.push_back(start + t);
    start += u.frames;
  }
  if (rows.empty()) throw std::runtime_error("no training frame was measured: are all lost?");
  return thinned(rows, static_cast<std::size_t>(node.max_frames));
}

/// The chosen frames of an utterance.
struct Block {
  std::size_t utterance;            ///< its number
  Eigen::MatrixXd frames;           ///< all of the utterance, described
  Eigen::Index at;                  ///< first row of the chosen in the covariance
  std::vector<Eigen::Index> local;  ///< the chosen, counted from its first frame

  auto size() const { return static_cast<Eigen::Index>(local.size()); }
};

std::vector<Block> blocks_of(const ContextGp& model, const std::vector<Eigen::Index>& rows) {
  std::vector<Block> blocks;
  Eigen::Index start = 0;
  std::size_t r = 0;
  for (std::size_t u = 0; u < model.lengths.size(); ++u) {
    const auto length = model.lengths[u];
    Block block{u, model.frames.middleRows(start, length), static_cast<Eigen::Index>(r), {}};
    for (; r < rows.size() && rows[r] < start + length; ++r) block.local.push_back(rows[r] - start);
    if (!block.local.empty()) blocks.push_back(std::move(block));
    start += length;
  }
  return blocks;
}

/// Kernel of the chosen frames; its upper triangle is not filled.
Eigen::MatrixXd covariance(const ContextGp& model, const std::vector<Eigen::Index>& rows, Context& context) {
  const auto blocks = blocks_of(model, rows);
  Eigen::MatrixXd k(rows.size(), rows.size());
  for (std::size_t j = 0; j < blocks.size(); ++j) {
    context.check_cancelled();
    const Block& b = blocks[j];
    for (std::size_t i = j; i < blocks.size(); ++i) {
      const Block& a = blocks[i];
      k.block(a.at, b.at, a.size(), b.size()) = kernel(model.window, a.frames, a.local, b.frames)(Eigen::all, b.local);
    }
    context.progress(0.5 * static_cast<double>(j + 1) / static_cast<double>(blocks.size()));
  }
  return k;
}

/// Kernel of some frames of an utterance (rows) with all training frames.
Eigen::MatrixXd kernel_with_training(const ContextGp& model, const Eigen::MatrixXd& f,
                                     const std::vector<Eigen::Index>& of) {
  Eigen::MatrixXd k(static_cast<Eigen::Index>(of.size()), model.frames.rows());
  Eigen::Index start = 0;
  for (const auto length : model.lengths) {
    k.middleCols(start, length) = kernel(model.window, f, of, model.frames.middleRows(start, length));
    start += length;
  }
  return k;
}

/// A process that lacks its weights.
struct Prepared {
  ContextGp model;
  std::vector<Utterance> utterances;
  std::vector<Eigen::Index> rows;  ///< of the frames that are learnt
  Eigen::MatrixXd targets;         ///< their visual parameters less the mean
};

Prepared prepare(const TrainContextGp& node, const Collected<Track>& audio, const Collected<PhoneTrack>& phones,
                 const Collected<Track>& visual) {
  Prepared p;
  p.utterances = pair_up(audio, phones, visual);
  const auto& utterances = p.utterances;
  auto& model = p.model;
  z_score(utterances, model);
  model.phones = inventory(utterances);
  const auto heard = model.audio_mean.size(), said = std::ssize(model.phones);
  Eigen::VectorXd costs(heard + said);
  costs.head(heard).setConstant(node.sound / static_cast<double>(heard));
  costs.tail(said).setConstant(node.phones);
  model.map = (0.5 * costs).cwiseSqrt().asDiagonal();
  model.window = window_of(node.reach, node.width);
  model.noise = node.noise;

  Eigen::Index total = 0;
  for (const auto& u : utterances) total += u.frames;
  model.frames.resize(total, model.map.cols());
  Eigen::MatrixXd z(total, utterances[0].visual->dimension());
  Eigen::Index at = 0;
  for (const auto& u : utterances) {
    model.frames.middleRows(at, u.frames) = described(model, *u.audio, *u.phones, u.frames);
    z.middleRows(at, u.frames) = u.visual->values.topRows(u.frames);
    model.lengths.push_back(u.frames);
    at += u.frames;
  }

  p.rows = chosen(node, utterances);
  p.targets = z(p.rows, Eigen::all);
  model.mean = p.targets.colwise().mean();
  p.targets.rowwise() -= model.mean;
  return p;
}

/// The learnt frames of utterances in which anybody speaks.
std::vector<KernelExample> examples_of(const Prepared& p) {
  const Eigen::RowVectorXd deviation =
      (p.targets.colwise().squaredNorm() / static_cast<double>(p.targets.rows())).cwiseSqrt();
  const Eigen::RowVectorXd scale = (deviation.array() > 0).select(deviation.cwiseInverse(), 1.0);
  const Eigen::Index n = p.model.window.size() / 2;
  std::vector<KernelExample> examples;
  for (const Block& block : blocks_of(p.model, p.rows)) {
    const Utterance& u = p.utterances[block.utterance];
    const auto speech = near_speech(*u.phones, *u.audio, u.frames, 0);
    KernelExample example;
    example.counts.resize(block.size());
    for (Eigen::Index i = 0; i < block.size(); ++i)
      example.counts[i] = speech[static_cast<std::size_t>(block.local[static_cast<std::size_t>(i)])] ? 1 : 0;
    if (example.counts.isZero()) continue;
    for (Eigen::Index l = -n; l <= n; ++l) {
      auto at = block.local;
      for (auto& t : at) t = std::clamp<Eigen::Index>(t + l, 0, u.frames - 1);
      example.around.push_back(block.frames(at, Eigen::all));
    }
    example.targets = p.targets.middleRows(block.at, block.size()).array().rowwise() * scale.array();
    examples.push_back(std::move(example));
  }
  return examples;
}

void learn_kernel_of(Prepared& p, const TrainContextGp& node, Random& random, Context& context) {
  const auto examples = examples_of(p);
  if (examples.size() < 2)
    return context.warn(
        "fewer than two utterances with speech: the kernel stays as it is given, for it is learnt by leaving one out");
  ContextGp& model = p.model;
  const Eigen::Index c = model.map.cols();
  const auto kernel = learn_kernel({node.kernel_steps, node.kernel_utterances}, examples,
                                   {model.window, Eigen::MatrixXd::Identity(c, c), model.noise},
                                   model.audio_mean.size(), random, context);
  model.window = kernel.window;
  model.noise = kernel.noise;
  model.map *= kernel.map;
  model.frames *= kernel.map;
}

/// Cholesky's factor of the learnt frames' covariance with its noise, in the lower triangle.
Eigen::MatrixXd factor_of(const Prepared& p, Context& context) {
  Eigen::MatrixXd factor = covariance(p.model, p.rows, context);
  factor.diagonal().array() += p.model.noise;
  if (Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>>(factor).info() != Eigen::Success)
    throw std::runtime_error("the covariance of the training frames cannot be factorised: raise noise");
  return factor;
}

/// K_uu⁻¹ − (K_uu + K_uf K_fu / noise)⁻¹ of the inducing frames u and the learnt ones f, K_uu with a jitter of 1e-6.
Eigen::MatrixXd certainty(const ContextGp& model, const std::vector<Eigen::Index>& learnt, Context& context) {
  const auto size = static_cast<Eigen::Index>(model.inducing.size());
  Eigen::MatrixXd uu(size, size), uf(size, static_cast<Eigen::Index>(learnt.size()));
  std::vector<Eigen::Index> rows(model.inducing.begin(), model.inducing.end());
  for (const Block& block : blocks_of(model, rows)) {
    context.check_cancelled();
    const Eigen::MatrixXd k = kernel_with_training(model, block.frames, block.local);
    uu.middleRows(block.at, block.size()) = k(Eigen::all, rows);
    uf.middleRows(block.at, block.size()) = k(Eigen::all, learnt);
  }
  uu.diagonal().array() += 1e-6;
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(size, size);
  return uu.llt().solve(identity) - (uu + uf * uf.transpose() / model.noise).llt().solve(identity);
}

}  // namespace

Eigen::MatrixXd phone_shares(const PhoneTrack& phones, const std::vector<std::string>& inventory, const Track& like) {
  Eigen::MatrixXd shares = Eigen::MatrixXd::Zero(like.frames(), static_cast<Eigen::Index>(inventory.size()));
  const double rate = like.rate.value();
  for (const auto& phone : phones.phones) {
    const auto at = std::find(inventory.begin(), inventory.end(), phone.label);
    if (at == inventory.end()) continue;
    const double from = (phone.start - like.start) * rate + 0.5, to = (phone.end - like.start) * rate + 0.5;
    const auto first = std::max<Eigen::Index>(0, static_cast<Eigen::Index>(std::floor(from)));
    for (Eigen::Index t = first; t < like.frames() && static_cast<double>(t) < to; ++t)
      shares(t, at - inventory.begin()) +=
          std::max(0.0, std::min(to, static_cast<double>(t + 1)) - std::max(from, static_cast<double>(t)));
  }
  return shares;
}

ContextGp TrainContextGp::operator()(const Collected<Track>& audio, const Collected<PhoneTrack>& phones,
                                     const Collected<Track>& visual, Random& random, Context& context) const {
  Prepared p = prepare(*this, audio, phones, visual);
  if (kernel_steps > 0) learn_kernel_of(p, *this, random, context);
  Eigen::MatrixXd factor = factor_of(p, context);
  auto& [model, utterances, rows, z] = p;
  factor.triangularView<Eigen::Lower>().solveInPlace(z);
  model.signal = z.colwise().squaredNorm() / static_cast<double>(rows.size());
  factor.triangularView<Eigen::Lower>().adjoint().solveInPlace(z);
  factor.resize(0, 0);
  model.weights.setZero(model.frames.rows(), z.cols());
  model.weights(rows, Eigen::all) = z;
  const auto even = thinned(rows, static_cast<std::size_t>(inducing));
  model.inducing.assign(even.begin(), even.end());
  model.certainty = certainty(model, rows, context);
  context.log(fmt::format("{} of {} frames learnt, {} phones", rows.size(), model.frames.rows(), model.phones.size()));
  return std::move(model);
}

std::vector<HeldOut> leave_one_out(const TrainContextGp& node, const Collected<Track>& audio,
                                   const Collected<PhoneTrack>& phones, const Collected<Track>& visual,
                                   Context& context) {
  const Prepared p = prepare(node, audio, phones, visual);
  const auto& [model, utterances, rows, z] = p;
  if (utterances.size() < 2) throw std::runtime_error("one utterance only: there are no others to learn from");
  const Eigen::MatrixXd factor = factor_of(p, context);
  const auto lower = factor.triangularView<Eigen::Lower>();
  const Eigen::MatrixXd weights = lower.adjoint().solve(lower.solve(z));
  std::vector<HeldOut> held;
  for (const auto& u : utterances) held.push_back({u.key, {}, Eigen::MatrixXd(0, z.cols())});
  for (const Block& block : blocks_of(model, rows)) {
    context.check_cancelled();
    const auto from = factor.rows() - block.at;
    const Eigen::MatrixXd columns = factor.bottomRightCorner(from, from)
                                        .triangularView<Eigen::Lower>()
                                        .solve(Eigen::MatrixXd::Identity(from, block.size()));
    const Eigen::MatrixXd inverse = columns.transpose() * columns;
    auto& out = held[block.utterance];
    out.frames = block.local;
    out.predicted =
        (z.middleRows(block.at, block.size()) - inverse.llt().solve(weights.middleRows(block.at, block.size())))
            .rowwise() +
        model.mean;
    context.progress(0.5 + 0.5 * static_cast<double>(block.at + block.size()) / static_cast<double>(rows.size()));
  }
  return held;
}

PredictContextGp::Prediction PredictContextGp::operator()(const ContextGp& model, const Track& audio,
                                                          const PhoneTrack& phones) const {
  if (audio.dimension() != model.audio_mean.size())
    throw std::runtime_error(fmt::format("audio features of {} dimensions, the model was trained on {}",
                                         audio.dimension(), model.audio_mean.size()));
  if (!audio.values.allFinite())
    throw std::runtime_error("audio features with NaN or infinite values: look at the stage before");
  std::vector<Eigen::Index> all(static_cast<std::size_t>(audio.frames()));
  std::iota(all.begin(), all.end(), 0);
  const Eigen::MatrixXd k = kernel_with_training(model, described(model, audio, phones, audio.frames()), all);
  const Eigen::MatrixXd near = k(Eigen::all, std::vector<Eigen::Index>(model.inducing.begin(), model.inducing.end()));
  const Eigen::VectorXd known = (near * model.certainty).cwiseProduct(near).rowwise().sum().cwiseMin(1).cwiseMax(0);
  Track visual;
  visual.rate = audio.rate;
  visual.start = audio.start;
  Track variance = visual;
  visual.values = (k * model.weights).rowwise() + model.mean;
  variance.values = (1 + model.noise - known.array()).matrix() * model.signal;
  return {std::move(visual), std::move(variance)};
}

void describe(Description<TrainContextGp>& d) {
  d.type("mapping.context_gp").version(3).stored();
  d.summary("learns a Gaussian process of visual parameters whose kernel compares sound and phones on both sides");
  d.input("audio", "speech features at the video rate of the training utterances")
      .input("phones", "their phones with times")
      .input("visual", "their visual parameters, normalised")
      .output("model", "the process");
  d.param("reach", &TrainContextGp::reach).within(0, 50).unit("frames").doc("neighbours on each side");
  d.param("width", &TrainContextGp::width).positive().unit("frames").doc("of the window over the neighbours");
  d.param("sound", &TrainContextGp::sound)
      .at_least(0)
      .doc("what unrelated sound costs, natural logarithm of the kernel");
  d.param("phones", &TrainContextGp::phones).at_least(0).doc("what a different phone costs; 0: sound alone");
  d.param("noise", &TrainContextGp::noise).positive().doc("variance of the noise, of the signal's");
  d.param("kernel_steps", &TrainContextGp::kernel_steps)
      .at_least(0)
      .doc("in which window, noise and a map of sound and phones are learnt by leaving out utterances; 0: as given");
  d.param("kernel_utterances", &TrainContextGp::kernel_utterances).at_least(2).doc("of a step, drawn anew for each");
  d.param("margin", &TrainContextGp::margin).at_least(0).unit("frames").doc("around speech, where all is learnt");
  d.param("pauses", &TrainContextGp::pauses).at_least(1).doc("of other frames every n-th is learnt");
  d.param("max_frames", &TrainContextGp::max_frames).at_least(1).doc("most that are learnt, at even distances");
  d.param("inducing", &TrainContextGp::inducing).at_least(1).doc("frames by which the variance is approximated");
}

void describe(Description<PredictContextGp>& d) {
  d.type("mapping.context_gp_predict").version(2).summary("visual parameters of new speech by mapping.context_gp");
  d.input("model", "of mapping.context_gp")
      .input("audio", "speech features at the video rate")
      .input("phones", "with their times")
      .output("visual", &PredictContextGp::Prediction::visual, "mean of the process")
      .output("variance", &PredictContextGp::Prediction::variance, "variance of each visual parameter about it");
}

}  // namespace talkgraph
