#include "nodes/plot/latent.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <regex>

#include "nodes/latent/predictive.h"
#include "nodes/plot/contours.h"
#include "nodes/types/gpdm.h"
#include "tests/nodes/plot/latent_models.h"

namespace talkgraph {
namespace {

using test::bent_state;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// What a call throws.
template <class Call>
std::string complaint(const Call& call) {
  try {
    call();
  } catch (const std::exception& e) {
    return e.what();
  }
  return "nothing";
}

double area(const std::vector<Ring>& rings) {
  double sum = 0;
  for (const auto& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const auto &a = ring[i], &b = ring[(i + 1) % ring.size()];
      sum += 0.5 * (a.x() * b.y() - b.x() * a.y());
    }
  return sum;
}

TEST(Contours, EncloseWhatIsAboveALevel) {
  Eigen::MatrixXd plane(4, 6);
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 6; ++c) plane(r, c) = c + 0.5 * r;
  EXPECT_NEAR(area(rings_above(plane, -1)), 15, 1e-12);
  EXPECT_NEAR(area(rings_above(plane, 3.25)), 7.5, 1e-12) << "a straight line through the middle";
  EXPECT_TRUE(rings_above(plane, 7).empty());
}

TEST(Contours, GoAroundHillsAndHoles) {
  constexpr int n = 201;
  Eigen::MatrixXd ring(n, n);
  for (int r = 0; r < n; ++r)
    for (int c = 0; c < n; ++c) ring(r, c) = -std::abs(std::hypot(r - 100, c - 100) - 60);
  const auto rings = rings_above(ring, -20);
  ASSERT_EQ(rings.size(), 2u);
  EXPECT_NEAR(area(rings) / (std::numbers::pi * (80 * 80 - 40 * 40)), 1, 1e-3);
  EXPECT_LT(std::min(area({rings[0]}), area({rings[1]})), 0) << "the hole is run around the other way";
}

TEST(Contours, DecideSaddlesByTheirMean) {
  Eigen::MatrixXd saddle(2, 2);
  saddle << 1, -1, -1, 1;
  EXPECT_EQ(rings_above(saddle, 0.1).size(), 2u);
  EXPECT_EQ(rings_above(saddle, -0.1).size(), 1u);
}

TEST(LatentSpace, IsThatOfTheStateAskedFor) {
  const Value model =
      Value::of(test::switching({bent_state("k-ae-t", 4, 3), bent_state("t", 5, 3), bent_state("s", 2, 3)}));
  EXPECT_EQ(latent_space(model, "").label, "k-ae-t") << "\"t\" has most frames, but may be a pause";
  EXPECT_EQ(latent_space(Value::of(test::switching({bent_state("t", 5, 3), bent_state("s", 2, 3)})), "").label, "t");
  EXPECT_EQ(latent_space(model, "s").latents->rows(), 6);
  EXPECT_THAT(complaint([&] { latent_space(model, "k-ae-d"); }), HasSubstr("did you mean \"k-ae-t\"?"));
  EXPECT_THAT(complaint([&] { latent_space(model, "dh-ah-ah"); }), HasSubstr("without `state`"));
  EXPECT_THAT(complaint([] { latent_spaces(Value::of(Ssgpdm{})); }), HasSubstr("no states"));
  EXPECT_THAT(complaint([] { latent_spaces(Value::of(Track{})); }), HasSubstr("Track has no latent space"));
  EXPECT_THAT(complaint([] { latent_spaces(Value::of(Sgpdm{})); }), HasSubstr("0 latent points"));
}

TEST(LatentSpace, NamesFramesByLabelOrLabels) {
  const Value word = Value::of(bent_state("k-ae-t", 2, 3)), pause = Value::of(bent_state("lead_sil", 2, 3));
  EXPECT_THAT(latent_phones(latent_space(word, ""), {}), ElementsAre("k", "ae", "t", "k", "ae", "t"));
  EXPECT_THAT(latent_phones(latent_space(pause, ""), {})[2], "lead_sil");
  const FrameLabels three{{"a", "b", "c"}, 25}, four{{"a", "b", "c", "d"}, 25};
  EXPECT_THAT(latent_phones(latent_space(word, ""), {{"1", four}, {"2", three}}),
              ElementsAre("a", "b", "c", "a", "b", "c"))
      << "a label too many at a window's end";
  EXPECT_THAT(latent_phones(latent_space(word, ""), {{"1", {{"a", "b", "c", "d", "e", "f"}, 25}}}),
              ElementsAre("a", "b", "c", "d", "e", "f"));
  EXPECT_THAT(complaint([&] {
                latent_phones(latent_space(word, ""), {{"1", three}});
              }),
              HasSubstr("3 labels for 6 latent points"));
}

TEST(LatentSpace, OrdersDimensionsByRelevance) {
  Sgpdm state = bent_state("t", 6, 4);
  state.latents.col(1) *= 10;
  for (auto* process : {&state.audio, &state.visual})
    process->kernel = {{ArdTerm{2, Eigen::Vector3d(1, 1e-6, 1)}, WhiteTerm{0.1}}};
  state.latents.col(2) *= 3;
  const Value model = Value::of(state);
  const LatentSpace space = latent_space(model, "");
  const Eigen::MatrixXd centred = state.latents.rowwise() - state.latents.colwise().mean();
  EXPECT_NEAR(relevances(space)[2], 4 * centred.col(2).squaredNorm() / 24, 1e-9);
  Eigen::Index least = 0;
  relevances(space).minCoeff(&least);
  EXPECT_EQ(least, 1) << "wide as it is, the kernels do not look at it";
  const auto axes = latent_axes(space, {}, 2);
  EXPECT_EQ(axes[0].dimension + axes[1].dimension, 2);
  EXPECT_EQ(latent_axes(space, {3, 2}, 2)[0].dimension, 2);
  for (const auto& wrong : std::vector<std::vector<int>>{{1, 4}, {0, 1}, {2, 2}, {1}, {1, 2, 3}})
    EXPECT_THAT(complaint([&] { latent_axes(space, wrong, 2); }), HasSubstr("choose")) << wrong.size();
}

TEST(LatentSpace, TakesTheSegmentsOfItsState) {
  const Value model = Value::of(bent_state("t", 4, 3));
  const LatentSpace space = latent_space(model, "");
  Track path;
  path.values.setRandom(6, 4);
  const SegmentTrack segments{{{"s", 0, 2}, {"t", 2, 3}, {"t", 5, 1}, {"t", 6, 0}}, 6, 25};
  const auto parts = paths_within(space, {{"a", path}}, {{"a", segments}});
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0], path.values.block(2, 0, 3, 3));
  EXPECT_EQ(paths_within(space, {{"a", path}}, {}).size(), 1u);
  EXPECT_THAT(complaint([&] {
                paths_within(space, {{"a", path}}, {{"a", {{{"t", 4, 3}}, 7, 25}}});
              }),
              HasSubstr("frames 4 to 6"));
  path.values.setRandom(6, 2);
  EXPECT_THAT(complaint([&] { paths_within(space, {{"a", path}}, {}); }), HasSubstr("has 2 dimensions"));
}

TEST(PhoneColours, CountTheMostFrequentAndPoolTheRest) {
  std::vector<std::string> phones(5, "b");
  phones.insert(phones.end(), 9, "a");
  for (int i = 0; i < 20; ++i) phones.push_back("p" + std::to_string(i));
  const auto colours = phone_colours(phones);
  ASSERT_EQ(colours.names.size(), 13u);
  EXPECT_EQ(colours.names[0], "a");
  EXPECT_EQ(colours.names[12], "10 others");
  EXPECT_EQ(colours.counts[12], 10);
  EXPECT_EQ(colours.of_frame[0], 1u);
  EXPECT_EQ(colours.of_frame.back(), 12u);
  EXPECT_EQ(std::set<std::string>(colours.colours.begin(), colours.colours.end()).size(), 13u);
}

TEST(PlotLatent, ShowsThePrecisionOfTheProcess) {
  const Sgpdm state = bent_state("t", 6, 4);
  const Value model = Value::of(state);
  for (const auto& [name, process] :
       {std::pair{"audio", &state.audio}, {"visual", &state.visual}, {"dynamics", &*state.dynamics}}) {
    PlotLatent node;
    node.process = name;
    node.dimensions = {3, 1};
    const auto p = latent_picture(node, latent_space(model, ""), {}, {}, {});
    EXPECT_EQ(p.points.col(0), state.latents.col(2));
    EXPECT_EQ(p.points.col(1), state.latents.col(0));
    for (const auto& [r, c] : {std::pair<Eigen::Index, Eigen::Index>{0, 0}, {p.background.rows() - 1, 3}, {7, 79}}) {
      Eigen::RowVectorXd x = state.latents.colwise().mean();
      x[2] = p.x.low + (p.x.high - p.x.low) * static_cast<double>(c) / 79;
      x[0] = p.y.low + (p.y.high - p.y.low) * static_cast<double>(r) / static_cast<double>(p.background.rows() - 1);
      Predictive predictive;
      predictive.compute(*process, x);
      EXPECT_NEAR(p.background(r, c), -std::log(predictive.variance()[0]), 1e-9) << name;
    }
    EXPECT_GT(p.points.col(0).minCoeff(), p.x.low);
    EXPECT_LT(p.points.col(1).maxCoeff(), p.y.high);
  }
}

TEST(PlotLatent, DrawsPointsWhereTheyAre) {
  const Value model = Value::of(bent_state("k-ae-t", 1, 3));
  const auto p = latent_picture({}, latent_space(model, ""), {}, {}, {});
  const double height = 440 * (p.y.high - p.y.low) / (p.x.high - p.x.low);
  const std::string svg = PlotLatent{}(model, {}, {}, {}).svg;
  for (Eigen::Index t = 0; t < 3; ++t) {
    const std::string at =
        fmt::format("{:.1f} {:.1f}", 440 * p.x.share(p.points(t, 0)), height - height * p.y.share(p.points(t, 1)));
    EXPECT_THAT(svg, HasSubstr("d=\"M" + at + "h.01\" fill=\"none\" stroke=\"" +
                               p.phones.colours[p.phones.of_frame[static_cast<std::size_t>(t)]]));
  }
  EXPECT_THAT(svg, HasSubstr(">ae (1)</text>"));
  EXPECT_THAT(svg, HasSubstr("<title>k-ae-t: 3 frames in 1 window</title>"));
}

TEST(PlotLatent, DrawsSynthesisedPathsOnTop) {
  const Value model = Value::of(bent_state("t", 4, 3));
  Track path;
  path.values = Eigen::MatrixXd::Constant(2, 3, 40);
  const auto p = latent_picture({}, latent_space(model, ""), {}, {{"a", path}}, {});
  EXPECT_GT(p.x.high, 40) << "the picture makes room";
  EXPECT_THAT(PlotLatent{}(model, {}, {{"a", path}}, {}).svg, HasSubstr(">synthesised</text>"));
  EXPECT_THAT(PlotLatent{}(model, {}, {}, {}).svg, Not(HasSubstr(">synthesised</text>")));
}

TEST(PlotLatent, DrawsDegenerateModels) {
  Sgpdm still = bent_state("t", 3, 2);
  still.latents.setZero();
  for (const auto& state : {bent_state("t", 1, 1), bent_state("t", 5, 1), bent_state("t", 3, 4, 1), still}) {
    const std::string svg = PlotLatent{}(Value::of(state), {}, {}, {}).svg;
    EXPECT_THAT(svg, HasSubstr("</svg>"));
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, Not(HasSubstr("inf")));
  }
  const Value line = Value::of(bent_state("t", 3, 4, 1));
  EXPECT_EQ(latent_picture({}, latent_space(line, ""), {}, {}, {}).points.col(1),
            Eigen::VectorXd::LinSpaced(4, 0, 3).replicate(3, 1));
  EXPECT_THAT(PlotLatent{}(line, {}, {}, {}).svg, HasSubstr("frame of the window"));
  PlotLatent node;
  node.process = "dynamic";
  EXPECT_THAT(complaint([&] { node(line, {}, {}, {}); }), HasSubstr("did you mean \"dynamics\"?"));
  node.process = "dynamics";
  EXPECT_THAT(complaint([&] { node(Value::of(bent_state("t", 5, 1)), {}, {}, {}); }),
              HasSubstr("state \"t\" has no process \"dynamics\"; it has audio, visual"));
}

TEST(PlotLatent, EscapesLabels) {
  const std::string evil = "<script>alert(1)</script>";
  const std::string svg = PlotLatent{}(Value::of(bent_state(evil, 2, 3)), {}, {}, {}).svg;
  EXPECT_THAT(svg, Not(HasSubstr("<script")));
  EXPECT_THAT(svg, HasSubstr("&lt;script&gt;alert(1)&lt;/script&gt; (6)"));
}

TEST(PlotLatent, DrawsAGpdm) {
  const Sgpdm state = bent_state("t", 2, 4);
  Gpdm gpdm;
  gpdm.latents = state.latents;
  gpdm.lengths = state.lengths;
  gpdm.observations = state.visual;
  const Plot plot = PlotLatent{}(Value::of(gpdm), {{"s", {{"a", "a", "b", "b", "a", "a", "b", "b"}, 25}}}, {}, {});
  EXPECT_EQ(plot.title, "8 frames in 2 windows");
  EXPECT_THAT(plot.svg, HasSubstr("ln precision, observations"));
  EXPECT_THAT(plot.svg, HasSubstr(">b (4)</text>"));
}

}  // namespace
}  // namespace talkgraph
