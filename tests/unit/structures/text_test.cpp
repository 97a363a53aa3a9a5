// What counts as UTF-8, and what becomes of text that is none; files that cannot be read.
#include "lacon/catalog/text.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "lacon/catalog/messages.hpp"
#include "lacon/structures/formats/text_file.hpp"

namespace {

using lacon::as_utf8;

TEST(Text, ThatIsUtf8Stays) {
  for (const char* text : {"", "Body 1", "K\u00f6rper", "\u20ac", "\U0001f600", "\u07ff\u0800\uffff\U00010000\U0010ffff"}) {
    EXPECT_TRUE(lacon::is_utf8(text)) << text;
    EXPECT_EQ(as_utf8(text), text);
  }
}

TEST(Text, OfOtherBytesIsLatin1) {
  EXPECT_EQ(as_utf8("K\xf6rper"), "K\u00f6rper");
  EXPECT_EQ(as_utf8("\x80\xbf\xc0\xff"), "\u0080\u00bf\u00c0\u00ff");
}

TEST(Text, IsNoUtf8WhereACharacterIsCutOverlongASurrogateOrBeyondTheLast) {
  for (const char* text : {"\xc3", "a\xe2\x82", "\xf0\x9f\x98", "\x80", "\xc0\xaf", "\xc1\xbf", "\xe0\x80\xaf",
                           "\xf0\x80\x80\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xf8\x88\x80\x80\x80", "\xff", "\xc3("}) {
    EXPECT_FALSE(lacon::is_utf8(text)) << text;
    EXPECT_TRUE(lacon::is_utf8(as_utf8(text))) << text;
  }
}

TEST(TextFile, ThatCannotBeReadIsRefused) {
  for (const std::filesystem::path& file :
       {std::filesystem::temp_directory_path(), std::filesystem::path("/nowhere/mesh.mail")}) {
    try {
      lacon::read_text(file);
      FAIL() << file;
    } catch (const lacon::Error& error) {
      EXPECT_EQ(error.message().id, "BASE_2");
      EXPECT_NE(error.message().text.find(file.string()), std::string::npos) << error.message().text;
    }
  }
}

}  // namespace
