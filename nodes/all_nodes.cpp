#include "nodes/all_nodes.h"

#include <opencv2/core.hpp>

#include "nodes/context/register.h"
#include "nodes/corpus/register.h"
#include "nodes/evaluate/register.h"
#include "nodes/face/register.h"
#include "nodes/latent/register.h"
#include "nodes/mapping/register.h"
#include "nodes/media/register.h"
#include "nodes/model/register.h"
#include "nodes/normalise/register.h"
#include "nodes/phones/register.h"
#include "nodes/plot/register.h"
#include "nodes/report/register.h"
#include "nodes/smooth/register.h"
#include "nodes/speaker/register.h"
#include "nodes/speech/register.h"
#include "nodes/statistics/register.h"
#include "nodes/sync/register.h"
#include "nodes/voice/register.h"
#include "nodes/write/register.h"
#include "nodes/yardstick/register.h"

extern "C" void openblas_set_num_threads(int);

namespace talkgraph {

Registry all_nodes() {
  cv::setNumThreads(1);
  openblas_set_num_threads(1);
  Registry r;
  register_context(r);
  register_corpus(r);
  register_evaluate(r);
  register_face(r);
  register_latent(r);
  register_mapping(r);
  register_media(r);
  register_model(r);
  register_normalise(r);
  register_phones(r);
  register_plot(r);
  register_report(r);
  register_smooth(r);
  register_speaker(r);
  register_speech(r);
  register_statistics(r);
  register_sync(r);
  register_voice(r);
  register_write(r);
  register_yardstick(r);
  return r;
}

}  // namespace talkgraph
