#include "nodes/mapping/slds.h"

#include <fmt/format.h>

#include <tuple>

#include "nodes/latent/em.h"
#include "nodes/latent/lds.h"
#include "nodes/latent/lds_expectations.h"
#include "nodes/mapping/phone_chain.h"
#include "nodes/mapping/scaling.h"
#include "nodes/types/paired.h"

namespace talkgraph {

namespace {

/// A phone as training sees it.
struct PhoneFrames {
  Lds* system = nullptr;
  std::vector<Eigen::Index> rows;  ///< of the training frames
  Eigen::MatrixXd frames;
  LdsExpectations expectations{0};
};

/// Expectation maximisation of all phones that have a system of their own.
class SwitchingEm {
 public:
  SwitchingEm(Slds& model, const Sequences& data, const std::vector<std::string>& labels, int min_frames)
      : model_(model), data_(data), labels_(labels) {
    for (std::size_t n = 0; n < labels.size(); ++n) phones_[labels[n]].rows.push_back(static_cast<Eigen::Index>(n));
    std::erase_if(phones_, [&](const auto& phone) { return std::ssize(phone.second.rows) < min_frames; });
    for (auto& [label, phone] : phones_) {
      phone.system = &(model.phones[label] = model.shared);
      phone.frames = data.frames(phone.rows, Eigen::all);
    }
  }

  double expect() {
    for (auto& [label, phone] : phones_) phone.expectations = LdsExpectations(model_.shared.states());
    double log_likelihood = 0;
    Eigen::Index from = 0;
    for (const Eigen::Index length : data_.lengths) {
      LdsRegimes regimes;
      std::map<std::string, std::vector<Eigen::Index>> times;
      for (Eigen::Index t = 0; t < length; ++t) {
        const std::string& label = labels_[static_cast<std::size_t>(from + t)];
        regimes.push_back(&system_of(model_, label));
        times[label].push_back(t);
      }
      const LdsPosterior p = kalman_smoother(regimes, data_.frames.middleRows(from, length));
      for (const auto& [label, of_phone] : times)
        if (const auto phone = phones_.find(label); phone != phones_.end()) phone->second.expectations.add(p, of_phone);
      log_likelihood += p.log_likelihood;
      from += length;
    }
    return log_likelihood;
  }

  void maximise(const LdsConstraints& constraints) {
    for (auto& [label, phone] : phones_)
      talkgraph::maximise(*phone.system, phone.frames, phone.expectations, constraints);
  }

 private:
  Slds& model_;
  const Sequences& data_;
  const std::vector<std::string>& labels_;
  std::map<std::string, PhoneFrames> phones_;
};

}  // namespace

const Lds& system_of(const Slds& model, const std::string& phone) {
  const auto found = model.phones.find(phone);
  return found == model.phones.end() ? model.shared : found->second;
}

Slds TrainSlds::operator()(const Collected<Track>& audio, const Collected<Track>& visual,
                           const Collected<FrameLabels>& labels, Context& context) const {
  const JoinedStreams streams = sound ? side_by_side(audio, visual) : JoinedStreams{visual, 0};
  const Labelled training = labelled(streams.tracks, labels);
  Sequences data = measured_runs(training.tracks);
  const Eigen::Index heard = streams.audio;
  const Scaling both = scaling_of(data.frames);
  data.frames = scaled(both, data.frames);
  Slds model;
  std::tie(model.audio, model.visual) = split(both, heard);
  model.chain = phone_chain(training.labels, data.lengths);
  TrainLds train;
  train.latent_dimension = latent_dimension;
  train.covariance = covariance;
  train.floor = floor;
  LdsLimits limits{.apart = heard};
  if (bound > 0) limits.radius = bound;
  model.shared = train.fit(data, context, limits);
  const LdsConstraints constraints{Eigen::VectorXd::Constant(latent_dimension, train.state_floor),
                                   variance_floors(data.frames, floor), covariance, limits};
  SwitchingEm em(model, data, training.labels, min_frames);
  model.trace = run_em(
      {iterations, tolerance}, data.frames.rows(), fmt::format("SLDS of {} phones", model.phones.size()), context,
      [&] { return em.expect(); }, [&] { em.maximise(constraints); });
  return model;
}

void describe(Description<TrainSlds>& d) {
  d.type("mapping.slds").version(2).stored();
  d.summary("learns a switching linear dynamical system of the face, with phones as states");
  d.source("Thesis §5.1.1, Eqns 5.1-5.6; Ghahramani and Hinton 2000; Englebienne, Cootes and Rattray 2007");
  d.input("audio", "speech features at the video rate of the training sequences")
      .input("visual", "visual parameters of the training sequences")
      .input("labels", "phones at the video rate of the training sequences")
      .output("model", "the system of each phone");
  d.param("sound", &TrainSlds::sound)
      .doc("the same states give the sound, which synthesis then follows; in the source they give the face alone");
  d.param("latent_dimension", &TrainSlds::latent_dimension).at_least(1).doc("of the state");
  d.param("covariance", &TrainSlds::covariance).doc("of the noise of either stream");
  d.param("min_frames", &TrainSlds::min_frames)
      .at_least(1)
      .doc("phones of fewer training frames have the system of all phones together");
  d.param("bound", &TrainSlds::bound)
      .within(0, 1)
      .doc("most |eigenvalue| of A, below 1 so that a long phone comes to rest; 0: none, as in the source");
  describe_em(d, "either stream's noise");
}

}  // namespace talkgraph
