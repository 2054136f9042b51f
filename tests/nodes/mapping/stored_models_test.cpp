#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nodes/mapping/context_gp.h"
#include "nodes/mapping/context_gp_predict.h"
#include "nodes/mapping/coupled_hmm.h"
#include "nodes/mapping/coupled_hmm_synthesise.h"
#include "nodes/mapping/dpds.h"
#include "nodes/mapping/dpds_decode.h"
#include "nodes/mapping/dpds_synthesise.h"
#include "nodes/mapping/joint_gmm.h"
#include "nodes/mapping/phone_gaussians.h"
#include "nodes/mapping/shared_lds.h"
#include "nodes/mapping/shared_lds_synthesise.h"
#include "nodes/mapping/slds.h"
#include "nodes/mapping/slds_decode.h"
#include "nodes/mapping/slds_synthesise.h"
#include "nodes/mapping/trajectory_hmm.h"
#include "nodes/mapping/trajectory_hmm_synthesise.h"
#include "nodes/mapping/voice_puppetry.h"
#include "nodes/mapping/voice_puppetry_synthesise.h"
#include "nodes/mapping/windowed_cca.h"
#include "tests/nodes/latent/gaussian.h"
#include "tests/nodes/types/changed_members.h"

namespace talkgraph {
namespace {

using testing::each_change;
using testing::gaussian;
using testing::MemoryArchive;
using testing::refuses_or_answers;

constexpr Eigen::Index frames = 30;

Track track(Eigen::Index dims, std::uint64_t seed) {
  Track t;
  t.values = gaussian(frames, dims, seed);
  t.values.col(0).setConstant(2);
  return t;
}

FrameLabels spoken() {
  FrameLabels labels;
  for (Eigen::Index t = 0; t < frames; ++t) labels.labels.push_back(std::vector{"aa", "b", "s"}[t / 5 % 3]);
  return labels;
}

PhoneTrack timed() {
  PhoneTrack phones;
  for (int i = 0; i < 6; ++i) phones.phones.push_back({std::vector{"aa", "b", "s"}[i % 3], i / 5.0, (i + 1) / 5.0});
  return phones;
}

class StoredMappings : public ::testing::Test {
 protected:
  /// Each change of a member is refused or does no harm; at least `least` are refused, and a matrix without finite
  /// values by its name.
  template <class Model>
  void check(Model model, const std::function<Eigen::MatrixXd(const Model&)>& use, int least) {
    MemoryArchive whole;
    fields(whole, model);
    whole.loads = true;
    each_change(whole, [](const std::string& path, MemoryArchive damaged) {
      const auto* matrix = std::get_if<Eigen::MatrixXd>(&damaged.members.at(path));
      if (!matrix || matrix->size() == 0 || matrix->allFinite()) return;
      const std::string name = path.substr(path.rfind('/') + 1);
      try {
        Model loaded;
        fields(damaged, loaded);
        FAIL() << path;
      } catch (const std::runtime_error& e) {
        EXPECT_THAT(e.what(), ::testing::HasSubstr("damaged"));
        EXPECT_THAT(e.what(), ::testing::HasSubstr(name));
      }
    });
    EXPECT_GE(refuses_or_answers<Model>(model, use), least);
  }

  const Collected<Track> audio{{"a", track(3, 1)}, {"b", track(3, 2)}}, visual{{"a", track(2, 3)}, {"b", track(2, 4)}};
  const Collected<FrameLabels> labels{{"a", spoken()}, {"b", spoken()}};
  const Track heard = track(3, 5);
  Random random{1};
  Context context;
};

TEST_F(StoredMappings, ThatAreStatesFitTogetherOrAreRefused) {
  const auto trajectory = [&](const TrajectoryHmm& m) { return SynthesiseTrajectoryHmm{}(m, heard, labels[0]).values; };
  TrainTrajectoryHmm trees;
  trees.states = 2;
  trees.occupancy = 1;
  trees.penalty = 0;
  trees.iterations = trees.descent = 2;
  check<TrajectoryHmm>(trees(audio, visual, labels, context), trajectory, 60);
  TrainCoupledHmm coupled;
  coupled.audio_states = coupled.visual_states = 3;
  coupled.iterations = 2;
  check<CoupledHmm>(
      coupled(audio, visual, random, context),
      [&](const CoupledHmm& m) { return SynthesiseCoupledHmm{}(m, heard).values; }, 40);
  TrainVoicePuppetry puppetry;
  puppetry.states = 4;
  check<VoicePuppetry>(
      puppetry(audio, visual, random, context),
      [&](const VoicePuppetry& m) { return SynthesiseVoicePuppetry{}(m, heard).values; }, 40);
}

TEST_F(StoredMappings, ThatAreDynamicalSystemsFitTogetherOrAreRefused) {
  TrainSharedLds shared;
  shared.iterations = 2;
  check<SharedLds>(
      shared(audio, visual, context), [&](const SharedLds& m) { return SynthesiseSharedLds{}(m, heard).values; }, 25);
  TrainSlds switching;
  switching.iterations = 2;
  switching.min_frames = 10;
  for (const bool sound : {false, true}) {
    switching.sound = sound;
    check<Slds>(
        switching(audio, visual, labels, context),
        [&](const Slds& m) -> Eigen::MatrixXd {
          const Track face = SynthesiseSlds{}(m, heard, labels[0]);
          EXPECT_EQ(DecodeSlds{}(m, face, context).labels.size(), labels[0].labels.size());
          if (sound) {
            EXPECT_EQ(DecodeSlds{SldsStream::audio}(m, heard, context).labels.size(), labels[0].labels.size());
          }
          return face.values;
        },
        60);
  }
  const auto use_dpds = [&](const Dpds& m) -> Eigen::MatrixXd {
    const Track face = SynthesiseDpds{}(m, heard, labels[0]);
    EXPECT_EQ(DecodeDpds{}(m, face).labels.size(), labels[0].labels.size());
    return face.values;
  };
  check<Dpds>(TrainDpds{}(visual, labels, context), use_dpds, 25);
}

TEST_F(StoredMappings, WithoutStatesFitTogetherOrAreRefused) {
  TrainJointGmm joint;
  joint.components = 2;
  check<JointGmm>(
      joint(audio, visual, random, context), [&](const JointGmm& m) { return SynthesiseJointGmm{}(m, heard).values; },
      30);
  check<PhoneGaussians>(
      TrainPhoneGaussians{}(visual, labels, context),
      [&](const PhoneGaussians& m) { return SynthesisePhoneGaussians{}(m, labels[0]).values; }, 15);
  TrainWindowedCca windowed;
  windowed.context = 1;
  check<WindowedCca>(
      windowed(audio, visual, context), [&](const WindowedCca& m) { return SynthesiseWindowedCca{}(m, heard).values; },
      25);
  const Collected<PhoneTrack> phones{{"a", timed()}, {"b", timed()}};
  TrainContextGp soft;
  soft.inducing = 10;
  check<ContextGp>(
      soft(audio, phones, visual, random, context),
      [&](const ContextGp& m) -> Eigen::MatrixXd {
        const auto face = PredictContextGp{}(m, heard, timed());
        return face.visual.values + face.variance.values;
      },
      35);
}

}  // namespace
}  // namespace talkgraph
