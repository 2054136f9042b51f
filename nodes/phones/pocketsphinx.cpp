#include "nodes/phones/pocketsphinx.h"

#include <pocketsphinx.h>
#include <sphinxbase/err.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <sstream>
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
/// or the sound goes on (`open`) those of the best one so far.
std::vector<FrameSpan> run_search(ps_decoder_t* ps, std::span<const std::int16_t> sound, bool open) {
  // A new stream forgets the noise level of earlier sound.
  if (ps_start_stream(ps) < 0 || ps_start_utt(ps) < 0)
    throw std::runtime_error("phones: PocketSphinx cannot start an utterance");
  const int searched = ps_process_raw(ps, sound.data(), sound.size(), FALSE, TRUE);
  std::vector<FrameSpan> so_far = segments(ps);
  if (ps_end_utt(ps) < 0 || searched < 0) throw std::runtime_error("phones: PocketSphinx failed on the sound");
  std::vector<FrameSpan> complete = segments(ps);
  return complete.empty() || open ? so_far : complete;
}

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

/// Long sound is searched in windows of this length, in frames: PocketSphinx counts frames in 16 bits.
constexpr int kWindow = 6000;
/// Words that nobody says within a window.
constexpr std::size_t kMostWords = 600;

/// The window that begins at a frame, and whether the sound goes on beyond it.
std::pair<std::span<const std::int16_t>, bool> window_from(std::span<const std::int16_t> sound, int start) {
  const auto rest = sound.subspan(static_cast<std::size_t>(start) * kSphinxHop);
  const auto window = rest.first(std::min<std::size_t>(rest.size(), std::size_t{kWindow} * kSphinxHop));
  return {window, window.size() < rest.size()};
}

/// Where a window that is not the last may end: in the middle of its last pause that
/// has 5 s of the window behind it, which show that the words go on from there; without
/// a pause, before the last span that has 10 s behind it.
int last_anchor(const std::vector<FrameSpan>& spans) {
  constexpr int kPause = 20, kBehind = 500, kFarBehind = 1000;
  int pause = 0, boundary = 0;
  for (const auto& span : spans) {
    const int middle = (span.start + span.end) / 2;
    if (is_filler(span) && span.end - span.start >= kPause && middle <= kWindow - kBehind) pause = middle;
    if (span.start <= kWindow - kFarBehind) boundary = span.start;
  }
  return pause > kWindow / 4 ? pause : boundary;
}

/// Appends the spans that start before `end`, later by `shift`; the last ends there.
void append_until(int end, int shift, std::vector<FrameSpan> spans, std::vector<FrameSpan>& all) {
  for (auto& span : spans) {
    if (span.start >= end) break;
    all.push_back({std::move(span.label), span.start + shift, std::min(span.end, end) + shift, span.score});
  }
}

}  // namespace

bool is_filler(const FrameSpan& span) {
  return span.label.starts_with('<') || span.label.starts_with('[') || span.label.starts_with('+') ||
         span.label == "SIL";
}

struct SphinxAligner::Decoder {
  DecoderPtr search;  ///< finds the words; it evaluates every second frame, which takes half the time
  DecoderPtr states;  ///< aligns the states of words that were found

  /// The words in the sound with pauses, in their order; fewer where they do not fit.
  std::vector<FrameSpan> find(std::span<const std::int16_t> sound, std::span<const std::string> words) const;
  /// The same in sound of at most a window: of words that go on beyond it (`open`) those that it holds.
  std::vector<FrameSpan> find_in_window(std::span<const std::int16_t> sound, std::span<const std::string> words,
                                        bool open) const;
  /// Makes the features of the sound and says of how many frames.
  int features(std::span<const std::int16_t> sound) const;
  /// Phones of words that are known to be in the sound, by Viterbi over their states, and
  /// the words' times and scores; empty if the words do not fit.
  std::vector<FrameSpan> align_states(std::span<const std::int16_t> sound, std::vector<FrameSpan>& words) const;
  void check_layout() const;
};

void SphinxAligner::Decoder::check_layout() const {
  const DecoderHead& d = head(states.get());
  const bool decoder_fits = d.config == ps_get_config(states.get()) && d.lmath == ps_get_logmath(states.get()) &&
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
  acmod_s* acmod = head(states.get()).acmod;
  const std::int16_t* samples = sound.data();
  std::size_t count = sound.size();
  if (ps_start_stream(states.get()) < 0 || acmod_start_utt(acmod) < 0)
    throw std::runtime_error("phones.align: PocketSphinx cannot start an utterance");
  const int frames = acmod_process_raw(acmod, &samples, &count, TRUE);
  if (frames < 0 || acmod_end_utt(acmod) < 0)
    throw std::runtime_error("phones.align: PocketSphinx failed on the sound");
  return frames;
}

std::vector<FrameSpan> SphinxAligner::Decoder::align_states(std::span<const std::int16_t> sound,
                                                            std::vector<FrameSpan>& words) const {
  const DecoderHead& d = head(states.get());
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
    const int end = e.start + e.duration;
    phones.push_back(
        {dict_ciphone_str(d.dict, ids[word], position), e.start, end, static_cast<double>(e.score) / e.duration});
    FrameSpan& whole = words[static_cast<std::size_t>(word)];
    if (position == 0) whole = {std::move(whole.label), e.start, end, 0};
    whole.end = end;
    whole.score += e.score;
  }
  for (auto& w : words) w.score /= w.end - w.start;
  return phones;
}

SphinxAligner::SphinxAligner() : decoder_(std::make_unique<Decoder>()) {
  const std::string dictionary = kModel / "cmudict-en-us.dict";
  decoder_->search = make_decoder({"-dict", dictionary, "-fsgusefiller", "yes", "-fsgusealtpron", "yes", "-ds", "2",
                                   "-beam", "1e-300", "-wbeam", "1e-300", "-pbeam", "1e-300"});
  decoder_->states = make_decoder({"-dict", dictionary, "-topn", "8"});
  decoder_->check_layout();
}
SphinxAligner::~SphinxAligner() = default;

bool SphinxAligner::knows(const std::string& word) const {
  return dict_wordid(head(decoder_->states.get()).dict, word.c_str()) >= 0;
}

std::vector<std::string> SphinxAligner::pronunciation(const std::string& word) const {
  const std::unique_ptr<char, void (*)(void*)> found(ps_lookup_word(decoder_->states.get(), word.c_str()), std::free);
  std::vector<std::string> phones;
  std::istringstream text(found ? found.get() : "");
  for (std::string phone; text >> phone;) phones.push_back(phone);
  return phones;
}

void SphinxAligner::learn(const std::string& word, const std::vector<std::string>& phones) {
  std::string spelling;
  for (const auto& phone : phones) spelling += (spelling.empty() ? "" : " ") + phone;
  for (char& c : spelling) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  for (const auto& ps : {decoder_->search.get(), decoder_->states.get()})
    if (phones.empty() || ps_add_word(ps, word.c_str(), spelling.c_str(), FALSE) < 0)
      throw std::runtime_error("phones.align: the pronunciation \"" + spelling + "\" of \"" + word +
                               "\" has phones that the model does not know");
}

std::vector<FrameSpan> SphinxAligner::Decoder::find_in_window(std::span<const std::int16_t> sound,
                                                              std::span<const std::string> words, bool open) const {
  ps_decoder_t* ps = search.get();
  const int nodes = static_cast<int>(words.size()) + 1;
  const std::unique_ptr<fsg_model_t, FreeGrammar> grammar(fsg_model_init(
      "words", ps_get_logmath(ps), static_cast<float32>(cmd_ln_float_r(ps_get_config(ps), "-lw")), nodes));
  grammar->start_state = 0;
  grammar->final_state = nodes - 1;
  for (int i = 0; i + 1 < nodes; ++i)
    fsg_model_trans_add(grammar.get(), i, i + 1, 0,
                        fsg_model_word_add(grammar.get(), words[static_cast<std::size_t>(i)].c_str()));
  if (ps_set_fsg(ps, "words", grammar.get()) < 0 || ps_set_search(ps, "words") < 0)
    throw std::runtime_error("phones.align: PocketSphinx does not take the words");
  return run_search(ps, sound, open);
}

std::vector<FrameSpan> SphinxAligner::Decoder::find(std::span<const std::int16_t> sound,
                                                    std::span<const std::string> words) const {
  std::vector<FrameSpan> found;
  for (int start = 0;;) {
    const auto [window, open] = window_from(sound, start);
    auto spans = words.empty() ? std::vector<FrameSpan>{{"<sil>", 0, static_cast<int>(window.size() / kSphinxHop), 0}}
                               : find_in_window(window, words.first(std::min(words.size(), kMostWords)), open);
    const int end = open ? last_anchor(spans) : kWindow;
    const std::size_t before = found.size();
    append_until(end, start, std::move(spans), found);
    if (!open || end == 0) return found;
    words = words.subspan(
        static_cast<std::size_t>(std::count_if(found.begin() + static_cast<std::ptrdiff_t>(before), found.end(),
                                               [](const auto& span) { return !is_filler(span); })));
    start += end;
  }
}

SphinxAligner::Result SphinxAligner::align(std::span<const std::int16_t> sound, const std::vector<std::string>& words) {
  const auto found = decoder_->find(sound, words);
  const auto spoken = std::count_if(found.begin(), found.end(), [](const auto& w) { return !is_filler(w); });
  if (static_cast<std::size_t>(spoken) != words.size()) return {found, {}};
  Result result;
  const auto append = [](const std::vector<FrameSpan>& spans, int shift, std::vector<FrameSpan>& all) {
    for (const auto& span : spans) all.push_back({span.label, span.start + shift, span.end + shift, span.score});
  };
  for (Piece& piece : pieces(found)) {
    const std::size_t first = static_cast<std::size_t>(piece.start) * kSphinxHop;
    const std::size_t last =
        piece.end == found.back().end ? sound.size() : static_cast<std::size_t>(piece.end) * kSphinxHop;
    const auto phones = decoder_->align_states(sound.subspan(first, last - first), piece.words);
    if (phones.empty()) return {found, {}};
    append(piece.words, piece.start, result.words);
    append(phones, piece.start, result.phones);
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
  std::vector<FrameSpan> found;
  for (int start = 0;;) {
    const auto [window, open] = window_from(sound, start);
    auto spans = run_search(decoder_->ps.get(), window, open);
    const int end = open ? last_anchor(spans) : kWindow;
    append_until(end, start, std::move(spans), found);
    if (!open || end == 0) return found;
    start += end;
  }
}

}  // namespace talkgraph
