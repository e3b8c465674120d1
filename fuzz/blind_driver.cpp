// Runs a fuzz target without libFuzzer: on every file of the corpus, then on mutations of them.
// Takes libFuzzer's -runs=N and -seed=N and folders; the same arguments give the same inputs.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz_target.hpp"

namespace {

using Random = std::mt19937_64;

std::size_t below(std::size_t bound, Random& random) {
  return static_cast<std::size_t>(random() % bound);
}

/// One mutation: replaces or inserts a byte, or removes, repeats or copies a piece.
std::string mutate(std::string text, const std::vector<std::string>& corpus, Random& random) {
  const std::size_t at = below(text.size() + 1, random);
  const std::size_t length = below(16, random);
  const char byte = static_cast<char>(below(256, random));
  switch (below(5, random)) {
    case 0:
      if (at < text.size()) text[at] = byte;
      break;
    case 1:
      text.insert(at, 1, byte);
      break;
    case 2:
      text.erase(at, length);
      break;
    case 3:
      text.insert(at, text.substr(at, length));
      break;
    default:
      const std::string& other = corpus[below(corpus.size(), random)];
      text.insert(at, other.substr(below(other.size() + 1, random), length));
  }
  return text;
}

std::vector<std::string> readCorpus(const std::vector<std::string>& folders) {
  std::vector<std::filesystem::path> paths;
  for (const std::string& folder : folders) {
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> corpus{""};
  for (const std::filesystem::path& path : paths) {
    std::ifstream file(path, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return corpus;
}

void runOn(const std::string& text) {
  std::ofstream("crash-input", std::ios::binary) << text;  // remains after a crash
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t runs = 10000;
  Random::result_type seed = 1;
  std::vector<std::string> folders;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument.rfind("-runs=", 0) == 0) {
      runs = std::stoull(argv[i] + 6);
    } else if (argument.rfind("-seed=", 0) == 0) {
      seed = std::stoull(argv[i] + 6);
    } else if (argument.rfind('-', 0) != 0) {
      folders.emplace_back(argument);
    }
  }
  const std::vector<std::string> corpus = readCorpus(folders);
  for (const std::string& text : corpus) runOn(text);
  Random random(seed);
  for (std::size_t run = 0; run < runs; ++run) {
    std::string text = corpus[below(corpus.size(), random)];
    for (std::size_t change = 0; change <= below(8, random); ++change)
      text = mutate(std::move(text), corpus, random);
    runOn(text);
  }
  std::filesystem::remove("crash-input");
  std::printf("%zu inputs of the corpus and %zu mutations\n", corpus.size(), runs);
}
