// Seals: every small damage is seen, wherever it is.
#include "lacon/structures/seal.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <random>
#include <sstream>
#include <string>

#include "lacon/catalog/messages.hpp"

namespace {

struct Sealed : testing::Test {
  std::filesystem::path file = testing::TempDir() + "lacon_seal_test_" + std::to_string(getpid());
  std::string whole;

  ~Sealed() override { std::filesystem::remove(file); }

  void write(const std::string& bytes) const { std::ofstream(file, std::ios::binary) << bytes; }
  void make(std::size_t length) {
    std::mt19937 chance(static_cast<unsigned>(length));
    std::string content(length, '\0');
    for (char& c : content) c = static_cast<char>(chance());
    write(content);
    lacon::seal(file);
    std::ostringstream bytes;
    bytes << std::ifstream(file, std::ios::binary).rdbuf();
    whole = bytes.str();
    ASSERT_EQ(whole.size(), length + 32);
    EXPECT_EQ(whole.substr(0, length), content);
    lacon::write_with_seal(file, content);
    EXPECT_EQ((std::ostringstream() << std::ifstream(file, std::ios::binary).rdbuf()).str(), whole);
    lacon::check_seal(file);
  }
  void refused(const std::string& bytes, const std::string& what) const {
    write(bytes);
    try {
      lacon::check_seal(file);
      ADD_FAILURE() << what;
    } catch (const lacon::Error& error) {
      EXPECT_EQ(error.message().id, "BASE_5") << what;
    }
  }
};

TEST_F(Sealed, AByteThatChangesIsSeen) {
  for (const std::size_t length : {1, 7, 8, 100}) {
    make(length);
    for (std::size_t at = 0; at < whole.size(); ++at) {
      if (at >= length && at < length + 8) continue;  // the mark: without it there is no seal
      std::string spoilt = whole;
      spoilt[at] = static_cast<char>(spoilt[at] ^ 0x10);
      refused(spoilt, std::to_string(length) + " " + std::to_string(at));
    }
  }
}

TEST_F(Sealed, WordsThatChangePlacesAreSeen) {
  make(1 << 19);  // more than one part of reading
  std::string spoilt = whole;
  std::swap_ranges(spoilt.begin() + 800, spoilt.begin() + 808, spoilt.begin() + (1 << 18) + 16);
  refused(spoilt, "two words");
}

TEST_F(Sealed, ContentThatIsLostInTheMiddleIsSeen) {
  make(4096);
  refused(whole.substr(0, 1000) + whole.substr(2000), "cut");
}

TEST_F(Sealed, AFileWithoutSealPasses) {
  for (const char* content : {"", "short", "a file that is longer than any seal would be, and has none"}) {
    write(content);
    EXPECT_NO_THROW(lacon::check_seal(file)) << content;
  }
}

TEST_F(Sealed, SomethingElseInThePlaceOfTheSealIsSeen) {
  std::string content = std::string("\x89HDF\r\n\x1a\n", 8) + std::string(92, '\0');
  content[13] = content[14] = 8;  // bytes of an offset and of a length
  content[40] = 100;              // where HDF5 says that the file ends
  for (const std::size_t zeros : {8, 16, 32, 50}) {
    std::string spoilt = content + "LACONSUM" + std::string(24, 'x');
    spoilt.replace(spoilt.size() - zeros, zeros, zeros, '\0');
    refused(spoilt, std::to_string(zeros));
  }
  write(content);
  EXPECT_NO_THROW(lacon::check_seal(file));
}

}  // namespace
