#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "nodes/latent/sequence_objective.h"
#include "nodes/latent/sgpdm.h"
#include "nodes/latent/sgpdm_objective.h"
#include "tests/nodes/latent/likelihoods.h"

namespace {
std::atomic<long> allocations = 0;
}

// What Eigen calls, by the linker's --wrap, and what everything else does.
extern "C" void* __real_malloc(std::size_t size);   // NOLINT(bugprone-reserved-identifier)
extern "C" void* __wrap_malloc(std::size_t size) {  // NOLINT(bugprone-reserved-identifier)
  ++allocations;
  return __real_malloc(size);
}
void* operator new(std::size_t size) {
  if (void* memory = malloc(size)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return malloc(size); }
// GCC 12 takes the two for strangers where it inlines only one of them.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
void operator delete(void* memory) noexcept { free(memory); }
void operator delete(void* memory, std::size_t) noexcept { free(memory); }

namespace talkgraph {
namespace {

using testing::gaussian;

TEST(Allocations, AreCounted) {
  const long before = allocations;
  Eigen::MatrixXd matrix(10, 10);
  EXPECT_EQ(allocations, before + 1);
  std::vector<double> numbers(100);
  EXPECT_EQ(allocations, before + 2);
}

TEST(Likelihood, AllocatesNothingAfterItsFirstEvaluation) {
  const Eigen::Index n = 250, k = 40;
  const Kernel kernel{
      {RbfTerm{1.3, 0.7}, ArdTerm{0.5, Eigen::Vector3d(1, 2, 3)}, LinearTerm{0.4}, BiasTerm{0.2}, WhiteTerm{0.1}}};
  const Eigen::MatrixXd x = gaussian(n, 3, 1), u = gaussian(k, 3, 2);
  for (const Eigen::Index outputs : {1, 7})
    for (const auto& approximation : testing::approximations({30, 40, 25, 5, 100, 50})) {
      const Eigen::MatrixXd y = gaussian(n, outputs, 3);
      const auto likelihood = approximation.make();
      GpGradient g;
      const auto evaluate = [&] {
        const long before = allocations;
        g.set_zero(n, k, 3, parameter_count(kernel));
        likelihood->evaluate(kernel, x, u, y, nullptr);
        likelihood->evaluate(kernel, x, u, y, &g);
        return allocations - before;
      };
      EXPECT_GT(evaluate(), 0);
      EXPECT_EQ(evaluate(), 0) << approximation.name << ", " << outputs << " outputs";
    }
}

/// Of one evaluation with its gradient, after two others.
long allocations_of(Objective& objective, const Eigen::VectorXd& at) {
  Eigen::VectorXd gradient;
  double cost = 0;
  long before = 0;
  for (int i = 0; i < 3; ++i) {
    before = allocations;
    EXPECT_TRUE(objective.evaluate(at, cost, &gradient));
  }
  return allocations - before;
}

GpStream stream(std::string name, KernelTerm first, KernelTerm second, const std::vector<std::int64_t>& lengths) {
  return {std::move(name),
          {{first, second, WhiteTerm{0.1, 0.01}}},
          gaussian(20, 3, 5),
          make_likelihood(CovarianceApproximation::fitc, lengths, 20)};
}

TEST(SgpdmObjective, AllocatesNothingAfterItsFirstEvaluations) {
  for (const auto back_constraint : {BackConstraintKind::none, BackConstraintKind::mlp, BackConstraintKind::kbr})
    for (const bool learn_scale : {false, true}) {
      SgpdmProblem p;
      p.lengths = {100, 100};
      p.latents = gaussian(200, 3, 1);
      for (const Eigen::Index outputs : {6, 5})
        p.observations.push_back({stream("observed", RbfTerm{1, 1}, BiasTerm{0.1}, p.lengths),
                                  gaussian(200, outputs, 2), Eigen::RowVectorXd::Ones(outputs), learn_scale});
      p.dynamics = stream("dynamics", RbfTerm{0.1, 1}, LinearTerm{1}, {99, 99});
      const Eigen::MatrixXd& y = p.observations[0].values;
      if (back_constraint == BackConstraintKind::mlp) p.back_constraint.emplace(perceptron(y, p.latents, 5), y);
      if (back_constraint == BackConstraintKind::kbr)
        p.back_constraint.emplace(kernel_regression(y, p.latents, 0.3), y);
      SgpdmObjective objective(std::move(p));
      EXPECT_EQ(allocations_of(objective, objective.start()), 0)
          << "back-constraint " << static_cast<int>(back_constraint) << ", scales learnt " << learn_scale;
    }
}

TEST(SequenceObjective, AllocatesNothingAfterItsFirstEvaluations) {
  StateData data{"a", {}, {}};
  for (std::uint64_t i = 0; i < 20; ++i) {
    data.audio.push_back(gaussian(7, 6, i));
    data.visual.push_back(gaussian(7, 5, 100 + i));
  }
  Context context;
  for (const auto form : {LatentDynamics::absolute, LatentDynamics::difference}) {
    TrainSgpdm train;
    train.dynamics = form;
    train.iterations = 2;
    const Sgpdm model = train(data, context);
    const Eigen::MatrixXd audio = gaussian(7, 6, 1);
    SequenceObjective objective(model, audio, true);
    objective.follow(gaussian(1, 5, 2), 0.5);
    EXPECT_EQ(allocations_of(objective, gaussian(21, 1, 3)), 0);
  }
}

}  // namespace
}  // namespace talkgraph
