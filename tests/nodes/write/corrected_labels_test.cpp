#include <fmt/format.h>
#include <gtest/gtest.h>

#include <regex>

#include "nodes/corpus/manifest.h"
#include "nodes/media/audio_file.h"
#include "nodes/phones/align.h"
#include "nodes/voice/voice.h"
#include "nodes/write/labels.h"
#include "tests/temporary_folder.h"

#ifdef TALKGRAPH_ESPEAK

namespace talkgraph {
namespace {

void expect_equal(const std::vector<Interval>& a, const std::vector<Interval>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].label, b[i].label) << i;
    EXPECT_NEAR(a[i].start, b[i].start, 1e-7) << i;
    EXPECT_NEAR(a[i].end, b[i].end, 1e-7) << i;
  }
}

/// Praat's short text format: the numbers, texts and flags alone, a line each.
std::string short_format(const std::string& text) {
  std::string out = "File type = \"ooTextFile\"\nObject class = \"TextGrid\"\n\n";
  const std::string rest = text.substr(text.find("xmin"));
  const std::regex value("= ([0-9.]+|\"[^\"]*\")|(<exists>)");
  for (std::sregex_iterator it(rest.begin(), rest.end(), value), end; it != end; ++it)
    out += (*it)[1].str() + (*it)[2].str() + "\n";
  return out;
}

std::string utf16(const std::string& ascii) {
  std::string out = "\xfe\xff";
  for (const char c : ascii) out += std::string(1, '\0') + c;
  return out;
}

/// A sentence that was aligned, and its TextGrid as written.
class CorrectedLabels : public testing::Test {
 protected:
  void SetUp() override {
    const Transcript transcript{"In 1984 Bob bought 25 blue boats."};
    const Audio audio = speak(transcript.text, {}).audio;
    write_audio(folder.file("s.wav"), audio);
    Context context;
    aligned = Align{}(audio, &transcript, nullptr, nullptr, context).value();
    context.folder = folder.path();
    context.item = "s";
    WriteLabels{}(aligned.phones, &aligned.words, context);
    written = folder.read("labels/s.TextGrid");
  }

  /// What phones.align gives of a recording whose manifest names the labels.
  Alignment read_back(const std::string& text_grid) const {
    folder.write("corrected.TextGrid", text_grid);
    const std::string manifest = folder.write("manifest.json", R"({ "clips": [ { "id": "s", "audio": "s.wav",
        "phones": "corrected.TextGrid", "words": "corrected.TextGrid" } ] })");
    const Recording recording = Manifest{{manifest}}().next()->value;
    const auto word = [](const auto& part) { return part ? &*part : nullptr; };
    Context context;
    return Align{}(recording.audio(), word(recording.transcript), word(recording.words), word(recording.phones),
                   context)
        .value();
  }

  const test::TemporaryFolder folder;
  Alignment aligned;
  std::string written;
};

TEST_F(CorrectedLabels, ComeBackAsTheyWereWritten) {
  for (const std::string& text : {written, short_format(written), utf16(written), utf16(short_format(written))}) {
    const Alignment back = read_back(text);
    expect_equal(back.phones.phones, aligned.phones.phones);
    expect_equal(back.words.words, aligned.words.words);
  }
}

TEST_F(CorrectedLabels, ComeBackAsTheyWereCorrected) {
  auto phones = aligned.phones.phones;
  const std::size_t moved = phones.size() / 2;
  const std::string before = fmt::format("{:.9g}", phones[moved].start);
  const double later = phones[moved].start + 0.3 * (phones[moved].end - phones[moved].start);
  phones[moved].start = phones[moved - 1].end = later;
  // In both tiers, where a word begins there, as with Praat's linked boundaries.
  std::string text = std::regex_replace(written, std::regex("= " + before + "\n"), fmt::format("= {:.15g} \n", later));
  // The first vowel gets the label of another dictionary.
  const auto vowel = std::find_if(phones.begin(), phones.end(), [](const auto& phone) { return phone.label == "ih"; });
  text.replace(text.find("\"ih\""), 4, "\"AH0\"");
  vowel->label = "ah";
  expect_equal(read_back(text).phones.phones, phones);
}

}  // namespace
}  // namespace talkgraph

#endif
