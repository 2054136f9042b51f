#include "nodes/mapping/dpds_synthesise.h"

#include "nodes/mapping/phone_inventory.h"
#include "nodes/mapping/scaling.h"
#include "nodes/types/paired.h"

namespace talkgraph {

Track SynthesiseDpds::operator()(const Dpds& model, const Track& audio, const FrameLabels& labels) const {
  const Eigen::Index frames =
      common_frames("the speech", audio.frames(), "audio frames", std::ssize(labels.labels), "labels");
  const Eigen::Index dims = model.first.cols();
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(frames, dims);
  for (Eigen::Index t = 0; t < frames; ++t) {
    const Eigen::Index state = place_of(model.chain.phones, labels.labels[static_cast<std::size_t>(t)]);
    const bool known = state < model.first.rows();
    if (t == 0 && known) x.row(t) = model.first.row(state);
    if (t > 0) x.row(t) = x.row(t - 1);
    if (t > 0 && known) x.row(t) = x.row(t).cwiseProduct(model.prediction.row(state)) + model.offset.row(state);
  }
  return {restored(model.visual, x), audio.rate, audio.start, {}};
}

void describe(Description<SynthesiseDpds>& d) {
  d.type("mapping.dpds_synthesise").version(1);
  d.summary("visual features of new speech by a deterministic process dynamical system");
  d.source("Thesis §5.1.2, Eqns 5.9 and 5.10; Englebienne, Cootes and Rattray 2007");
  d.input("model", "of mapping.dpds")
      .input("audio", "speech features at the video rate, whose frames are filled")
      .input("labels", "phones at the video rate")
      .output("visual", "visual parameters");
}

}  // namespace talkgraph
