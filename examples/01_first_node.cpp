// 1. A node is called like the function that it is: no graph, no registry.
#include "01_first_node.h"

#include <iostream>

int main() {
  talkgraph::Audio audio;  // a second of a tone that fades in
  audio.samples =
      Eigen::VectorXd::LinSpaced(16000, 0, 16000).unaryExpr([](double n) { return n / 16000 * std::sin(n / 10); });
  const talkgraph::Track level = mine::Loudness{}(audio);
  for (const int t : {0, 10, 50, 99}) std::cout << level.time(t) << " s: " << level.values(t) << " dB\n";
}
