#pragma once

#include "graph/context.h"
#include "graph/description.h"
#include "graph/random.h"
#include "nodes/types/joint_gmm.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// Joint Gaussian mixture with minimum converted trajectory error (Zhuang, Wang, Soong and Hasegawa-Johnson 2010): a
/// mixture over audio and visual frames with their slopes, full covariances, by expectation maximisation from k-means;
/// for each frame the component that is likeliest given its sound; and the visual trajectory that, with its slopes, is
/// likeliest given these components and the sound (Toda, Black and Tokuda 2007). Then means and logarithms of variances
/// of the face given the sound take steps of scaled conjugate gradients down the mean squared error of the trajectories
/// of all training sequences.
///
/// Of the source this differs in that likelihoods of sound and face weigh alike in training the mixture, the variances
/// of the face given the sound are those of its dimensions alone, and the descent takes all sequences at once without a
/// learning rate. Frames are scaled to mean 0 and deviation 1 first. Every run of measured frames is a sequence. Throws
/// std::runtime_error, naming the track, if none has a measured frame, if lengths differ by more than two frames, on
/// different dimensions, and on values that are not finite.
struct TrainJointGmm {
  int components = 32;
  double floor = 1e-2;
  int iterations = 20;
  double tolerance = 1e-4;
  int descent = 60;

  JointGmm operator()(const Collected<Track>& audio, const Collected<Track>& visual, Random& random,
                      Context& context) const;
};
void describe(Description<TrainJointGmm>& d);

/// The likeliest visual trajectory given the sound's components.
struct SynthesiseJointGmm {
  Track operator()(const JointGmm& model, const Track& audio) const;
};
void describe(Description<SynthesiseJointGmm>& d);

}  // namespace talkgraph
