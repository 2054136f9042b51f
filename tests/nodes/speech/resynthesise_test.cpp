#include "nodes/speech/resynthesise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "graph/random.h"
#include "nodes/speech/deemphasis.h"
#include "nodes/speech/f0.h"
#include "nodes/speech/frame.h"
#include "nodes/speech/lattice.h"
#include "nodes/speech/line_spectrum.h"
#include "nodes/speech/lpc.h"
#include "nodes/speech/lsf.h"
#include "nodes/speech/preemphasis.h"
#include "nodes/speech/residual.h"

namespace talkgraph {
namespace {

constexpr double pi = std::numbers::pi;

/// A voice of 120 Hz whose resonances move, with a hiss in the middle and silence at the end.
Audio babble(double seconds = 1.5) {
  Random random(2);
  Audio a;
  const auto n = static_cast<Eigen::Index>(seconds * a.rate);
  a.samples.setZero(n);
  double phase = 0;
  for (Eigen::Index t = 4; t < n; ++t) {
    const double at = static_cast<double>(t) / static_cast<double>(n);
    phase += 120 / a.rate;
    double e = 0.0005 * random.normal();
    if (at > 0.4 && at < 0.5)
      e = 0.01 * random.normal();
    else if (phase >= 1)
      e += 0.05;
    phase -= std::floor(phase);
    if (at > 0.9) continue;
    const double first = 2 * pi * (500 + 200 * std::sin(2 * pi * 3 * at)) / a.rate, second = 2 * pi * 1500 / a.rate;
    const double r = 0.97, s = 0.95;
    const double b1 = 2 * r * std::cos(first), b2 = -r * r, c1 = 2 * s * std::cos(second), c2 = -s * s;
    a.samples[t] = e + (b1 + c1) * a.samples[t - 1] + (b2 + c2 - b1 * c1) * a.samples[t - 2] -
                   (b1 * c2 + b2 * c1) * a.samples[t - 3] - b2 * c2 * a.samples[t - 4];
  }
  return a;
}

struct Analysis {
  Track lsf, gain, f0;
};

Analysis analysed(const Audio& audio, double rate = 100) {
  Context context;
  const auto fps = Rational(static_cast<std::int64_t>(rate));
  const LpcTracks lpc = Lpc{.window = {}}(Frame{.rate = fps, .centred = true}(PreEmphasis{}(audio)));
  return {Lsf{}(lpc.lpc, context), lpc.gain, F0{}(Frame{.window = 0.04, .rate = fps, .centred = true}(audio))};
}

double rms(const Eigen::VectorXd& x) { return std::sqrt(x.squaredNorm() / static_cast<double>(x.size())); }

TEST(Resynthesise, TheResidualGivesTheSoundBack) {
  const Audio audio = PreEmphasis{}(babble());
  for (const double rate : {25.0, 100.0}) {
    const Track lsf = analysed(babble(), rate).lsf;
    const Audio residual = Residual{}(audio, lsf);
    EXPECT_LT(rms(residual.samples), 0.7 * rms(audio.samples));
    Random random(1);
    const Audio back = Resynthesise{}(lsf, nullptr, nullptr, &residual, random);
    EXPECT_LT((back.samples - audio.samples).cwiseAbs().maxCoeff(), 1e-10);
  }
}

TEST(Lattice, IsTheDirectFilterOfItsPredictor) {
  Random random(7);
  Eigen::VectorXd lsf(20), a(20), k(20), y(1000);
  for (auto& x : lsf) x = random.uniform(0, pi);
  keep_apart(0.05, lsf);
  predictor_of(lsf, a);
  ASSERT_TRUE(step_down(a, k));
  Lattice analysis(20), synthesis(20);
  analysis.set(k);
  synthesis.set(k);
  for (Eigen::Index t = 0; t < y.size(); ++t) {
    const double e = random.normal();
    y[t] = e;
    for (Eigen::Index i = 1; i <= std::min<Eigen::Index>(20, t); ++i) y[t] += a[i - 1] * y[t - i];
    const double scale = 1 + std::abs(y[t]);
    EXPECT_NEAR(synthesis.synthesise(e) / scale, y[t] / scale, 1e-9);
    EXPECT_NEAR(analysis.analyse(y[t]) / scale, e / scale, 1e-9);
  }
}

// Switched at random, each step the power of one filter stays that of what goes in: no gain builds up.
TEST(Lattice, StaysBoundedHoweverItChanges) {
  Random random(8);
  Lattice lattice(20);
  Eigen::VectorXd k(20);
  double most = 0, allowed = 0;
  for (int t = 0; t < 100000; ++t) {
    if (t % 10 == 0)
      for (auto& x : k) x = random.uniform(-0.99, 0.99);
    lattice.set(k);
    const double e = t < 1000 ? random.normal() : 0;
    allowed += std::pow(e / (1 - k.array().square()).sqrt().prod(), 2);  // rotations keep energy
    most = std::max(most, std::abs(lattice.synthesise(e)));
  }
  EXPECT_LE(most * most, allowed);
}

// Sound of pulses and noise, analysed again, has the parameters that it was made of.
TEST(Resynthesise, HasTheSpectraAndTheEnergyOfTheOriginal) {
  const Audio audio = babble();
  const Analysis a = analysed(audio);
  Random random(1);
  const Audio made = Deemphasis{}(Resynthesise{}(a.lsf, &a.gain, &a.f0, nullptr, random));
  ASSERT_EQ(made.samples.size(), audio.samples.size());
  const Analysis b = analysed(made);
  double level = 0, distance = 0, pitch = 0;
  int frames = 0, tones = 0;
  for (Eigen::Index t = 5; t < a.lsf.frames() * 0.85; ++t, ++frames) {
    const auto energy = [&](const Audio& x) { return rms(x.samples.segment(t * 160 - 160, 480)); };
    level += std::abs(20 * std::log10(energy(made) / energy(audio)));
    distance += (a.lsf.values.row(t) - b.lsf.values.row(t)).cwiseAbs().mean();
    if (a.f0.values(t, 0) > 0 && b.f0.values(t, 0) > 0) {
      pitch += std::abs(a.f0.values(t, 0) / b.f0.values(t, 0) - 1);
      ++tones;
    }
  }
  EXPECT_LT(level / frames, 1.5) << "dB";
  EXPECT_LT(distance / frames, 0.03) << "rad";
  EXPECT_GT(tones, 60);
  EXPECT_LT(pitch / tones, 0.02);
  EXPECT_LT(rms(made.samples.tail(800)), 1e-3 * rms(audio.samples));
}

TEST(Resynthesise, ExcitesWithThePowerThatIsAskedFor) {
  Track lsf, gain, tone;
  lsf.rate = gain.rate = tone.rate = 100;
  lsf.values = Eigen::RowVectorXd::LinSpaced(22, 0, pi).segment(1, 20).replicate(300, 1);  // A = 1
  gain.values.setConstant(300, 1, 0.1);
  for (const double voicing : {0.0, 0.5, 1.0}) {
    tone.values.resize(300, 2);
    tone.values << Eigen::VectorXd::Constant(300, 160), Eigen::VectorXd::Constant(300, voicing);
    Random random(3);
    const Audio audio = Resynthesise{}(lsf, &gain, &tone, nullptr, random);
    EXPECT_NEAR(rms(audio.samples), 0.1, 0.003) << voicing;
  }
  Random random(3);
  const Audio pulses = Resynthesise{.f0 = 160, .level = 0.2}(lsf, nullptr, nullptr, nullptr, random);
  EXPECT_NEAR(rms(pulses.samples), 0.2, 0.005);
  EXPECT_EQ((pulses.samples.array() > 1).count(), pulses.samples.size() / 100);
  EXPECT_NEAR(pulses.samples.mean(), 0, 1e-3);
  const Audio noise = Resynthesise{.f0 = 0, .level = 0.2}(lsf, nullptr, nullptr, nullptr, random);
  EXPECT_NEAR(rms(noise.samples), 0.2, 0.005);
  EXPECT_GT((noise.samples.array().abs() > 1e-9).count(), noise.samples.size() * 0.99);
}

TEST(Resynthesise, KeepsThePitchBesideUnvoicedFrames) {
  Track lsf, tone;
  lsf.rate = tone.rate = 10;
  lsf.values = Eigen::RowVectorXd::LinSpaced(22, 0, pi).segment(1, 20).replicate(10, 1);
  tone.values.setZero(10, 2);
  tone.values.block(4, 0, 1, 2) << 200, 1;
  Random random(1);
  const Audio audio = Resynthesise{}(lsf, nullptr, &tone, nullptr, random);
  Eigen::Index last = -1;
  for (Eigen::Index t = 6000; t < 6900; ++t)  // a pulse stands out of its noise by √80
    if (audio.samples[t] > 0.05) {
      if (last >= 0) {
        EXPECT_EQ(t - last, 80);
      }
      last = t;
    }
  EXPECT_GT(last, 0);
}

TEST(Resynthesise, IsTheSameForASeed) {
  const Analysis a = analysed(babble(0.3));
  Random one(9), same(9), other(8);
  const auto made = [&](Random& random) { return Resynthesise{}(a.lsf, &a.gain, &a.f0, nullptr, random).samples; };
  const Eigen::VectorXd first = made(one);
  EXPECT_EQ(first, made(same));
  EXPECT_NE(first, made(other));
}

// Where frames meet, the sound jumps no more than elsewhere.
TEST(Resynthesise, HasNoClicksWhereFramesMeet) {
  const Analysis a = analysed(babble());
  Track pulse_free = a.f0;
  pulse_free.values.setZero();
  Random random(4);
  const Audio made = Resynthesise{}(a.lsf, &a.gain, &pulse_free, nullptr, random);
  const auto n = made.samples.size();
  // Second differences in units of their neighbourhood, at steps of the filter and in their middle.
  double at_steps = 0, between = 0;
  for (Eigen::Index t = 400; t + 400 < n * 0.85; t += 40) {
    const auto bend = [&](Eigen::Index i) {
      return std::pow(made.samples[i + 1] - 2 * made.samples[i] + made.samples[i - 1], 2) /
             (1e-20 + made.samples.segment(i - 100, 200).squaredNorm());
    };
    at_steps += bend(t);
    between += bend(t + 20);
  }
  EXPECT_NEAR(at_steps / between, 1, 0.25);
}

TEST(Resynthesise, StaysFiniteOnWildTracks) {
  Random random(11);
  Track lsf, gain, tone;
  lsf.rate = 100;
  lsf.values.resize(200, 20);
  for (auto& x : lsf.values.reshaped()) x = random.uniform(-1, 5);
  gain.values.setConstant(7, 1, 0.01);
  tone.values.resize(3, 2);
  tone.values << 1e9, 7, -5, 2, 1e-9, -3;
  const Audio audio = Resynthesise{}(lsf, &gain, &tone, nullptr, random);
  EXPECT_TRUE(audio.samples.allFinite());
}

TEST(Resynthesise, SilenceStaysSilent) {
  Audio silence;
  silence.samples.setZero(8000);
  const Analysis a = analysed(silence);
  Random random(1);
  EXPECT_TRUE(Resynthesise{}(a.lsf, &a.gain, &a.f0, nullptr, random).samples.isZero(0));
}

TEST(Resynthesise, RefusesBrokenTracks) {
  Random random(1);
  Track good, broken;
  good.values = Eigen::RowVectorXd::LinSpaced(22, 0, pi).segment(1, 20);
  broken.values.setConstant(1, 20, NAN);
  const Resynthesise resynthesise;
  EXPECT_THROW(resynthesise(Track{}, nullptr, nullptr, nullptr, random), std::runtime_error);
  EXPECT_THROW(resynthesise(broken, nullptr, nullptr, nullptr, random), std::runtime_error);
  EXPECT_THROW(resynthesise(good, &broken, nullptr, nullptr, random), std::runtime_error);
  EXPECT_THROW(resynthesise(good, nullptr, &broken, nullptr, random), std::runtime_error);
  EXPECT_THROW((Resynthesise{.spacing = 0.2}(good, nullptr, nullptr, nullptr, random)), std::invalid_argument);
}

TEST(Deemphasis, UndoesPreemphasisAfterSilence) {
  Audio audio = babble(0.5);
  EXPECT_LT((Deemphasis{}(PreEmphasis{}(audio)).samples - audio.samples).cwiseAbs().maxCoeff(), 1e-12);
  audio.samples.resize(0);
  EXPECT_EQ(Deemphasis{}(audio).samples.size(), 0);
}

}  // namespace
}  // namespace talkgraph
