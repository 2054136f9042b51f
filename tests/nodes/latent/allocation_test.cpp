#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "tests/nodes/latent/likelihoods.h"

namespace {
std::atomic<long> allocations = 0;
}

// What Eigen calls, by the linker's --wrap, and what everything else does.
extern "C" void* __real_malloc(std::size_t size);
extern "C" void* __wrap_malloc(std::size_t size) {
  ++allocations;
  return __real_malloc(size);
}
void* operator new(std::size_t size) {
  if (void* memory = malloc(size)) return memory;
  throw std::bad_alloc();
}
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

}  // namespace
}  // namespace talkgraph
