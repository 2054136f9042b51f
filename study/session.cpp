#include "study/session.h"

#include <algorithm>
#include <map>

#include "graph/random.h"

namespace talkgraph::study {
namespace {

std::vector<const Clip*> draw(const Test& test, Random& random) {
  std::map<std::string, std::vector<const Clip*>> categories;
  for (const auto& clip : test.clips) categories[clip.category()].push_back(&clip);
  std::vector<const Clip*> drawn;
  for (auto& [name, clips] : categories) {
    random.shuffle(clips);
    clips.resize(std::min(clips.size(), static_cast<std::size_t>(test.per_category)));
    drawn.insert(drawn.end(), clips.begin(), clips.end());
  }
  random.shuffle(drawn);
  return drawn;
}

}  // namespace

std::vector<Showing> plan(const Study& study, std::uint64_t seed) {
  Random order(seed);
  std::vector<const Test*> tests;
  for (const auto& test : study.tests) tests.push_back(&test);
  order.shuffle(tests);
  std::vector<Showing> all;
  for (const auto* test : tests) {
    Random random(seed, "study", test->id);
    int position = 0;
    for (const auto* clip : draw(*test, random)) all.push_back({test, clip, position++});
  }
  return all;
}

const std::vector<std::string>& options(const Question& question, const Clip& clip) {
  return question.options.empty() ? clip.choices : question.options;
}

}  // namespace talkgraph::study
