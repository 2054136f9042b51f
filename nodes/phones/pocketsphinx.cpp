#include "nodes/phones/pocketsphinx.h"

#include <pocketsphinx.h>
#include <sphinxbase/err.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <mutex>
#include <stdexcept>

// The state aligner of libpocketsphinx 0.8+5prealpha is exported but has no
// public header: these are its declarations, and the leading members of its
// structures that are read here. check_layout() compares them with what the
// public functions say before they are trusted.
extern "C" {
struct acmod_s;
struct dict_s;
struct dict2pid_s;
struct ps_search_s;
struct ps_alignment_s;
struct ps_alignment_iter_s;

struct ps_alignment_entry_s {
  union {
    int32 wid;
    struct {
      uint16 ssid, cipid, tmatid;
    } pid;
    uint16 senid;
  } id;
  int16 start, duration;
  int32 score;
  uint16 parent, child;
};

ps_alignment_s* ps_alignment_init(dict2pid_s*);
int ps_alignment_free(ps_alignment_s*);
int ps_alignment_add_word(ps_alignment_s*, int32 wid, int duration);
int ps_alignment_populate(ps_alignment_s*);
int ps_alignment_n_phones(ps_alignment_s*);
ps_alignment_iter_s* ps_alignment_phones(ps_alignment_s*);
ps_alignment_entry_s* ps_alignment_iter_get(ps_alignment_iter_s*);
ps_alignment_iter_s* ps_alignment_iter_next(ps_alignment_iter_s*);
ps_search_s* state_align_search_init(const char* name, cmd_ln_t*, acmod_s*, ps_alignment_s*);
int32 dict_wordid(dict_s*, const char*);
const char* dict_ciphone_str(dict_s*, int32 wid, int32 position);
int acmod_start_utt(acmod_s*);
int acmod_process_raw(acmod_s*, const int16** sound, size_t* samples, int whole_utterance);
int acmod_end_utt(acmod_s*);
int acmod_advance(acmod_s*);
void acmod_clear_active(acmod_s*);
}

namespace talkgraph {
namespace {

/// The leading members of ps_decoder_s.
struct DecoderHead {
  cmd_ln_t* config;
  int refcount;
  acmod_s* acmod;
  dict_s* dict;
  dict2pid_s* d2p;
  logmath_t* lmath;
};

/// The leading members of ps_search_s and its functions.
struct SearchFunctions {
  int (*start)(ps_search_s*);
  int (*step)(ps_search_s*, int frame);
  int (*finish)(ps_search_s*);
  int (*reinit)(ps_search_s*, dict_s*, dict2pid_s*);
  void (*free)(ps_search_s*);
};
struct SearchHead {
  SearchFunctions* functions;
  char* type;
  char* name;
  ps_search_s* lookahead;
  cmd_ln_t* config;
  acmod_s* acmod;
  dict_s* dict;
  dict2pid_s* d2p;
};

const DecoderHead& head(ps_decoder_t* ps) { return *reinterpret_cast<const DecoderHead*>(ps); }
const SearchHead& head(ps_search_s* search) { return *reinterpret_cast<const SearchHead*>(search); }

const std::filesystem::path kModel = "/usr/share/pocketsphinx/model/en-us";

struct FreeDecoder {
  void operator()(ps_decoder_t* ps) const { ps_free(ps); }
};
struct FreeConfig {
  void operator()(cmd_ln_t* config) const { cmd_ln_free_r(config); }
};
struct FreeSearch {
  void operator()(ps_search_s* search) const { head(search).functions->free(search); }
};
struct FreeAlignment {
  void operator()(ps_alignment_s* alignment) const { ps_alignment_free(alignment); }
};
struct FreeGrammar {
  void operator()(fsg_model_t* grammar) const { fsg_model_free(grammar); }
};
using DecoderPtr = std::unique_ptr<ps_decoder_t, FreeDecoder>;
using SearchPtr = std::unique_ptr<ps_search_s, FreeSearch>;

void say_nothing(void*, err_lvl_t, const char*, ...) {}

/// The library reports to a handler of the process and a file of the thread.
void silence_log() {
  static std::once_flag once;
  std::call_once(once, [] { err_set_callback(say_nothing, nullptr); });
  err_set_logfp(nullptr);
}

DecoderPtr make_decoder(std::vector<std::string> options) {
  silence_log();
  if (!std::filesystem::exists(kModel / "en-us" / "mdef"))
    throw std::runtime_error("phones: no acoustic model in " + kModel.string() +
                             "; install the Debian package pocketsphinx-en-us");
  options.insert(options.begin(), {"-hmm", kModel / "en-us", "-remove_silence", "no", "-dither", "no", "-bestpath",
                                   "no", "-pl_window", "0"});
  std::vector<char*> arguments;
  for (auto& option : options) arguments.push_back(option.data());
  const std::unique_ptr<cmd_ln_t, FreeConfig> config(
      cmd_ln_parse_r(nullptr, ps_args(), static_cast<int32>(arguments.size()), arguments.data(), TRUE));
  DecoderPtr ps(config ? ps_init(config.get()) : nullptr);
  if (!ps) throw std::runtime_error("phones: PocketSphinx cannot load its model from " + kModel.string());
  return ps;
}

std::vector<FrameSpan> segments(ps_decoder_t* ps) {
  std::vector<FrameSpan> found;
  for (ps_seg_t* segment = ps_seg_iter(ps); segment; segment = ps_seg_next(segment)) {
    FrameSpan span{ps_seg_word(segment), 0, 0, 0};
    if (span.label == "(NULL)") continue;
    ps_seg_frames(segment, &span.start, &span.end);
    int32 acoustic = 0;
    ps_seg_prob(segment, &acoustic, nullptr, nullptr);
    ++span.end;
    span.score = static_cast<double>(acoustic) / std::max(1, span.end - span.start);
    found.push_back(std::move(span));
  }
  return found;
}

/// Searches the sound: the spans of the best complete path, and if there is none
/// those of the best one so far.
std::vector<FrameSpan> search(ps_decoder_t* ps, std::span<const std::int16_t> sound) {
  // A new stream forgets the noise level of earlier sound.
  if (ps_start_stream(ps) < 0 || ps_start_utt(ps) < 0)
    throw std::runtime_error("phones: PocketSphinx cannot start an utterance");
  const int searched = ps_process_raw(ps, sound.data(), sound.size(), FALSE, TRUE);
  std::vector<FrameSpan> so_far = segments(ps);
  if (ps_end_utt(ps) < 0 || searched < 0) throw std::runtime_error("phones: PocketSphinx failed on the sound");
  std::vector<FrameSpan> complete = segments(ps);
  return complete.empty() ? so_far : complete;
}

constexpr int kHop = 160;  // samples

/// A part of an utterance for the state aligner, whose time and memory grow
/// with the square of the length.
struct Piece {
  int start = 0;
  int end = 0;
  std::vector<FrameSpan> words;
};

/// Cuts in pauses once a piece has 15 s, at any word once it has 30 s.
std::vector<Piece> pieces(const std::vector<FrameSpan>& words) {
  constexpr int kLong = 1500, kTooLong = 3000, kPause = 20;
  std::vector<Piece> all(1);
  for (const auto& word : words) {
    const int length = word.end - all.back().start;
    if (length > kLong && is_filler(word) && word.end - word.start >= kPause) {
      const int middle = (word.start + word.end) / 2;
      all.back().words.push_back(word);
      all.back().end = middle;
      all.push_back({middle, 0, {}});
    } else if (length > kTooLong && !all.back().words.empty()) {
      all.back().end = word.start;
      all.push_back({word.start, 0, {}});
    }
    all.back().words.push_back(word);
  }
  all.back().end = words.back().end;
  return all;
}

}  // namespace

bool is_filler(const FrameSpan& word) { return word.label.starts_with('<') || word.label.starts_with('['); }

double sphinx_boundary(int frame) { return 0.010 * frame + 0.0078; }

struct SphinxAligner::Decoder {
  DecoderPtr ps;

  /// Makes the features of the sound and says of how many frames.
  int features(std::span<const std::int16_t> sound) const;
  /// Phone times of words that are known to be in the sound, by Viterbi over their
  /// states; empty if the words do not fit.
  std::vector<FrameSpan> align_states(std::span<const std::int16_t> sound, std::span<const FrameSpan> words) const;
  void check_layout() const;
};

void SphinxAligner::Decoder::check_layout() const {
  const DecoderHead& d = head(ps.get());
  const bool decoder_fits = d.config == ps_get_config(ps.get()) && d.lmath == ps_get_logmath(ps.get()) &&
                            d.refcount == 1 && d.acmod && d.dict && d.d2p;
  bool search_fits = false;
  if (decoder_fits) {
    const int32 word = dict_wordid(d.dict, "<sil>");
    const std::unique_ptr<ps_alignment_s, FreeAlignment> alignment(ps_alignment_init(d.d2p));
    ps_alignment_add_word(alignment.get(), word, 0);
    if (word >= 0 && ps_alignment_populate(alignment.get()) == 0 && ps_alignment_n_phones(alignment.get()) == 1) {
      if (ps_search_s* search = state_align_search_init("test", d.config, d.acmod, alignment.get())) {
        const SearchHead& s = head(search);
        search_fits = s.config == d.config && s.acmod == d.acmod && s.d2p == d.d2p && s.dict == d.dict;
        if (search_fits) s.functions->free(search);
      }
    }
  }
  if (!search_fits)
    throw std::runtime_error(
        "phones.align: this libpocketsphinx is not the one whose state aligner is known (0.8+5prealpha, as in "
        "Debian 12); install that, or give phone labels with the corpus");
}

int SphinxAligner::Decoder::features(std::span<const std::int16_t> sound) const {
  acmod_s* acmod = head(ps.get()).acmod;
  const std::int16_t* samples = sound.data();
  std::size_t count = sound.size();
  if (ps_start_stream(ps.get()) < 0 || acmod_start_utt(acmod) < 0)
    throw std::runtime_error("phones.align: PocketSphinx cannot start an utterance");
  const int frames = acmod_process_raw(acmod, &samples, &count, TRUE);
  if (frames < 0 || acmod_end_utt(acmod) < 0)
    throw std::runtime_error("phones.align: PocketSphinx failed on the sound");
  return frames;
}

std::vector<FrameSpan> SphinxAligner::Decoder::align_states(std::span<const std::int16_t> sound,
                                                            std::span<const FrameSpan> words) const {
  const DecoderHead& d = head(ps.get());
  const std::unique_ptr<ps_alignment_s, FreeAlignment> alignment(ps_alignment_init(d.d2p));
  std::vector<int32> ids;
  for (const auto& word : words) {
    ids.push_back(dict_wordid(d.dict, word.label.c_str()));
    ps_alignment_add_word(alignment.get(), ids.back(), 0);
  }
  if (ps_alignment_populate(alignment.get()) < 0) throw std::runtime_error("phones.align: too many words at once");
  const SearchPtr search(state_align_search_init("phones", d.config, d.acmod, alignment.get()));
  const SearchFunctions& f = *head(search.get()).functions;

  const int frames = features(sound);
  acmod_clear_active(d.acmod);
  f.start(search.get());
  for (int frame = 0; frame < frames; ++frame) {
    if (f.step(search.get(), frame) < 0) throw std::runtime_error("phones.align: PocketSphinx failed on the sound");
    acmod_advance(d.acmod);
  }
  if (f.finish(search.get()) < 0) return {};

  std::vector<FrameSpan> phones;
  int word = -1;
  int position = 0;
  for (auto* it = ps_alignment_phones(alignment.get()); it; it = ps_alignment_iter_next(it)) {
    const ps_alignment_entry_s& e = *ps_alignment_iter_get(it);
    position = e.parent == word ? position + 1 : 0;
    word = e.parent;
    phones.push_back({dict_ciphone_str(d.dict, ids[word], position), e.start, e.start + e.duration, 0});
  }
  return phones;
}

SphinxAligner::SphinxAligner() : decoder_(std::make_unique<Decoder>()) {
  decoder_->ps = make_decoder({"-dict", kModel / "cmudict-en-us.dict", "-fsgusefiller", "yes", "-fsgusealtpron", "yes",
                               "-beam", "1e-300", "-wbeam", "1e-300", "-pbeam", "1e-300"});
  decoder_->check_layout();
}
SphinxAligner::~SphinxAligner() = default;

bool SphinxAligner::knows(const std::string& word) const {
  return dict_wordid(head(decoder_->ps.get()).dict, word.c_str()) >= 0;
}

void SphinxAligner::learn(const std::string& word, const std::vector<std::string>& phones) {
  std::string spelling;
  for (const auto& phone : phones) spelling += (spelling.empty() ? "" : " ") + phone;
  for (char& c : spelling) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  if (phones.empty() || ps_add_word(decoder_->ps.get(), word.c_str(), spelling.c_str(), FALSE) < 0)
    throw std::runtime_error("phones.align: the pronunciation \"" + spelling + "\" of \"" + word +
                             "\" has phones that the model does not know");
}

SphinxAligner::Result SphinxAligner::align(std::span<const std::int16_t> sound, const std::vector<std::string>& words) {
  ps_decoder_t* ps = decoder_->ps.get();
  const int states = static_cast<int>(words.size()) + 1;
  const std::unique_ptr<fsg_model_t, FreeGrammar> grammar(fsg_model_init(
      "words", ps_get_logmath(ps), static_cast<float32>(cmd_ln_float_r(ps_get_config(ps), "-lw")), states));
  grammar->start_state = 0;
  grammar->final_state = states - 1;
  for (int i = 0; i + 1 < states; ++i)
    fsg_model_trans_add(grammar.get(), i, i + 1, 0, fsg_model_word_add(grammar.get(), words[i].c_str()));
  if (ps_set_fsg(ps, "words", grammar.get()) < 0 || ps_set_search(ps, "words") < 0)
    throw std::runtime_error("phones.align: PocketSphinx does not take the words");

  Result result{search(ps, sound), {}};
  const auto spoken =
      std::count_if(result.words.begin(), result.words.end(), [](const auto& w) { return !is_filler(w); });
  if (static_cast<std::size_t>(spoken) != words.size()) return result;
  for (const Piece& piece : pieces(result.words)) {
    const std::size_t first = static_cast<std::size_t>(piece.start) * kHop;
    const std::size_t last = piece.end == result.words.back().end ? sound.size() : std::size_t(piece.end) * kHop;
    const auto phones = decoder_->align_states(sound.subspan(first, last - first), piece.words);
    if (phones.empty()) return {std::move(result.words), {}};
    for (const auto& phone : phones)
      result.phones.push_back({phone.label, phone.start + piece.start, phone.end + piece.start, 0});
  }
  return result;
}

struct SphinxPhoneLoop::Decoder {
  DecoderPtr ps;
};

SphinxPhoneLoop::SphinxPhoneLoop() : decoder_(std::make_unique<Decoder>()) {
  decoder_->ps = make_decoder({"-allphone", kModel / "en-us-phone.lm.bin", "-allphone_ci", "yes", "-lw", "2.0", "-beam",
                               "1e-20", "-pbeam", "1e-20"});
}
SphinxPhoneLoop::~SphinxPhoneLoop() = default;

std::vector<FrameSpan> SphinxPhoneLoop::decode(std::span<const std::int16_t> sound) {
  return search(decoder_->ps.get(), sound);
}

}  // namespace talkgraph
