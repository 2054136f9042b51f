// What latent models cost: the joint likelihood of an SGPDM with its gradient beside a matrix product of the same
// machine in the same run, training and a sequence optimisation. Processor time, but for the states of two threads.

#include <fmt/format.h>

#include <chrono>
#include <numeric>
#include <thread>

#include "bench/child.h"
#include "bench/rows.h"
#include "graph/random.h"
#include "nodes/latent/gp_likelihood.h"
#include "nodes/latent/scg.h"
#include "nodes/latent/sequence_objective.h"
#include "nodes/latent/sgpdm.h"

namespace talkgraph::bench {

constexpr Eigen::Index frames = 1000, inducing = 100, latent = 5, audio = 20, visual = 33;

Eigen::MatrixXd gaussian(Eigen::Index rows, Eigen::Index cols, std::uint64_t seed) {
  Random random(seed);
  return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return random.normal(); });
}

/// Two processes over the same latent points.
struct Joint {
  struct Stream {
    std::unique_ptr<GpLikelihood> likelihood;
    Eigen::MatrixXd y, u;
    GpGradient gradient;
  };

  explicit Joint(const std::function<std::unique_ptr<GpLikelihood>()>& make) {
    streams.push_back({make(), gaussian(frames, audio, 2), gaussian(inducing, latent, 4), {}});
    streams.push_back({make(), gaussian(frames, visual, 3), gaussian(inducing, latent, 5), {}});
  }
  void evaluate(bool with_gradient) {
    for (Stream& s : streams) {
      s.gradient.set_zero(frames, inducing, latent, parameter_count(kernel));
      s.likelihood->evaluate(kernel, x, s.u, s.y, with_gradient ? &s.gradient : nullptr);
    }
  }

  Kernel kernel{{RbfTerm{1, 0.5}, BiasTerm{0.1}, WhiteTerm{0.1, 1e-3}}};
  Eigen::MatrixXd x = gaussian(frames, latent, 1);
  std::vector<Stream> streams;
};

/// Seconds of one of `times` calls.
Row repeated(std::string name, int times, std::function<void()> work) {
  work();
  const auto seconds = own([times, work = std::move(work)] {
    for (int i = 0; i < times; ++i) work();
  });
  return {std::move(name), [=] { return seconds() / times; }};
}

std::string range(const Row& row, double scale, const char* digits) {
  return fmt::format(fmt::runtime(fmt::format("{{:{0}}} ({{:{0}}} to {{:{0}}})", digits)), scale * row.median(),
                     scale * row.seen.front(), scale * row.seen.back());
}

void likelihoods() {
  const std::vector<std::pair<std::string, std::function<std::unique_ptr<GpLikelihood>()>>> types{
      {"DTC", [] { return std::make_unique<DtcLikelihood>(); }},
      {"FITC", [] { return std::make_unique<FitcLikelihood>(); }},
      {"PITC, blocks of 100", [] { return std::make_unique<PitcLikelihood>(blocks_within({frames}, inducing)); }},
      {"variational", [] { return std::make_unique<VariationalLikelihood>(); }}};
  const Eigen::MatrixXd a = gaussian(frames, frames, 6), b = gaussian(frames, frames, 7);
  Eigen::MatrixXd product(frames, frames);
  std::vector<std::unique_ptr<Joint>> joints;
  std::vector<Row> rows{repeated("dgemm", 2, [&] { product.noalias() = a * b; })};
  for (const auto& [name, make] : types) {
    joints.push_back(std::make_unique<Joint>(make));
    for (const bool with_gradient : {true, false})
      rows.push_back(repeated(name + (with_gradient ? ", with gradient" : ""), 10,
                              [joint = joints.back().get(), with_gradient] { joint->evaluate(with_gradient); }));
  }
  measure(rows);
  const double peak = 2e-9 * std::pow(frames, 3) / rows[0].median();
  fmt::print(
      "Two processes, {} frames, {} inducing points each, {} latent dimensions, {} and {} outputs; median of {} (least "
      "to most); the product of two matrices of {} runs at {:.1f} GFLOP/s:\n\n| likelihood | ms |\n|---|---|\n",
      frames, inducing, latent, audio, visual, rounds, frames, peak);
  for (std::size_t i = 1; i < rows.size(); ++i) fmt::print("| {} | {} |\n", rows[i].name, range(rows[i], 1e3, ".2f"));
  constexpr double work = 192e6;  // of FITC with gradient, by the book
  fmt::print("\nFITC with its gradient is {:.0f} MFLOP by the book: {:.1f} GFLOP/s, {:.0f} % of the product's.\n\n",
             work / 1e6, 1e-9 * work / rows[3].median(), 1e-7 * work / rows[3].median() / peak);
}

/// Windows of smooth paths seen through random maps, as a state of speech has them.
StateData state(int windows, int length, std::uint64_t seed) {
  StateData data{fmt::format("state {}", seed), {}, {}};
  const auto to_audio = gaussian(4, audio, 101), to_visual = gaussian(4, visual, 102);
  Random random(seed);
  for (int w = 0; w < windows; ++w) {
    Eigen::MatrixXd path(length, 4);
    const double phase = random.normal(), speed = 0.4 + 0.1 * random.normal();
    for (int t = 0; t < length; ++t) {
      const double angle = phase + speed * t;
      path.row(t) << std::cos(angle), std::sin(angle), std::cos(2 * angle), std::sin(2 * angle);
    }
    const auto place = seed * 1000 + static_cast<std::uint64_t>(w);
    data.audio.push_back(path * to_audio + 0.3 * gaussian(length, audio, place));
    data.visual.push_back(path * to_visual + 0.3 * gaussian(length, visual, place + 500));
  }
  return data;
}

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void training() {
  constexpr int states = 24;
  std::vector<StateData> data;
  for (int i = 0; i < states; ++i) data.push_back(state(30, 7, static_cast<std::uint64_t>(i)));
  const auto train = [&](int first, int step) {
    Context context;
    for (int i = first; i < states; i += step) TrainSgpdm{}(data[static_cast<std::size_t>(i)], context);
  };
  std::vector<double> one, two, one_cpu, two_cpu;
  for (int round = 0; round < rounds; ++round) {
    double before = cpu_time();
    one.push_back(seconds_of([&] { train(0, 1); }));
    one_cpu.push_back(cpu_time() - before);
    before = cpu_time();
    two.push_back(seconds_of([&] {
      std::thread other(train, 1, 2);
      train(0, 2);
      other.join();
    }));
    two_cpu.push_back(cpu_time() - before);
  }
  fmt::print("| training states of 210 frames | states per second | per second of processor time |\n|---|---|---|\n");
  fmt::print("| one thread | {:.1f} | {:.1f} |\n", states / median(one), states / median(one_cpu));
  fmt::print("| two threads | {:.1f} | {:.1f} |\n\n", states / median(two), states / median(two_cpu));
}

void synthesis() {
  Context context;
  const Sgpdm model = TrainSgpdm{}(state(29, 7, 1), context);
  const Eigen::MatrixXd sound = model.audio_frames.topRows(7) + 0.2 * gaussian(7, audio, 9);
  OptimiserReport report;
  std::vector<Row> rows{repeated("sequence", 20, [&] {
    SequenceObjective objective(model, sound, true);
    Eigen::VectorXd x = model.latents.middleRows(7, 7).reshaped();
    ScaledConjugateGradients optimiser;
    optimiser.iterations = 15;  // as in synthesis
    optimiser.step_tolerance = optimiser.cost_tolerance = 1e-3;
    report = optimiser.minimise(objective, x);
  })};
  measure(rows);
  fmt::print("A sequence optimisation of 7 frames in a state of {} training frames takes {} ms: {} evaluations, {}.\n",
             model.latents.rows(), range(rows[0], 1e3, ".2f"), report.evaluations, str(report.reason));
}

}  // namespace talkgraph::bench

int main() {
  talkgraph::bench::likelihoods();
  talkgraph::bench::training();
  talkgraph::bench::synthesis();
}
