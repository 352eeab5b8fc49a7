#include "core/author/index.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

namespace whit::author {
namespace {

std::vector<std::string> names(const FileIndex& index, NameKind kind, bool defines) {
  std::vector<std::string> out;
  for (const Mention& m : index.mentions()) {
    if (m.kind == kind && m.defines == defines) out.push_back(m.name);
  }
  return out;
}
using Names = std::vector<std::string>;

TEST(FileIndex, FindsNamesInStatementsAndParameters) {
  const std::string text = R"(
    Texture "a" "float" "imagemap" "string filename" "a.png"
    Texture "b" "spectrum" "scale" "texture tex1" "a" "rgb tex2" [ 1 1 1 ]
    MakeNamedMaterial "m" "string type" "mix" "string namedmaterial1" "x" "string namedmaterial2" [ "y" ]
    Material "metal" "spectrum eta" "Cu.eta.spd"
    ObjectBegin "o" ObjectEnd ObjectInstance "o"
    CoordinateSystem "c" CoordSysTransform "c"
    MediumInterface "in" ""
    Include "more.pbrt"
  )";
  const FileIndex index(text);
  EXPECT_EQ(names(index, NameKind::FloatTexture, true), Names{"a"});
  EXPECT_EQ(names(index, NameKind::ColourTexture, true), Names{"b"});
  EXPECT_EQ(names(index, NameKind::AnyTexture, false), Names{"a"});
  EXPECT_EQ(names(index, NameKind::Material, true), Names{"m"});
  EXPECT_EQ(names(index, NameKind::Material, false), (Names{"x", "y"}));
  EXPECT_EQ(names(index, NameKind::Object, true), Names{"o"});
  EXPECT_EQ(names(index, NameKind::Object, false), Names{"o"});
  EXPECT_EQ(names(index, NameKind::CoordinateSystem, true), Names{"c"});
  EXPECT_EQ(names(index, NameKind::CoordinateSystem, false), Names{"c"});
  EXPECT_EQ(names(index, NameKind::Medium, false), Names{"in"});
  EXPECT_EQ(names(index, NameKind::Include, false), Names{"more.pbrt"});
  EXPECT_EQ(names(index, NameKind::Asset, false), (Names{"a.png", "Cu.eta.spd"}));
  for (const Mention& m : index.mentions()) EXPECT_EQ(text.substr(m.at.begin, m.at.size()), '"' + m.name + '"');
}

void expect_same(const FileIndex& a, const FileIndex& b, const std::string& text) {
  ASSERT_EQ(a.items().size(), b.items().size()) << text;
  for (size_t i = 0; i < a.items().size(); ++i) {
    EXPECT_EQ(a.items()[i].row, b.items()[i].row) << text;
    EXPECT_EQ(a.items()[i].at, b.items()[i].at) << text;
  }
  ASSERT_EQ(a.mentions().size(), b.mentions().size()) << text;
  for (size_t i = 0; i < a.mentions().size(); ++i) {
    EXPECT_EQ(a.mentions()[i].kind, b.mentions()[i].kind) << text;
    EXPECT_EQ(a.mentions()[i].at, b.mentions()[i].at) << text;
    EXPECT_EQ(a.mentions()[i].name, b.mentions()[i].name) << text;
  }
}

/// An index that is kept up to date says the same as one that is made anew, whatever is typed.
TEST(FileIndex, IsTheSameHoweverTheTextCameAbout) {
  const std::string pieces[] = {"Shape \"sphere\"",
                                "\n",
                                " ",
                                "AttributeBegin\n",
                                "AttributeEnd",
                                "\"",
                                "[",
                                "]",
                                "#",
                                "1",
                                "NamedMaterial \"m\"\n",
                                "MakeNamedMaterial \"m\" \"string type\" \"matte\"\n",
                                "Sh",
                                "\"texture Kd\" \"t\"",
                                "\"float radius\" [ 1 2 ]\n",
                                "Texture \"t\" \"float\" \"constant\"\n",
                                "\xef\xbb\xbf",
                                "Translate 1 2 3\n",
                                "\\",
                                "x"};
  std::mt19937 random(3);
  for (int run = 0; run < 200; ++run) {
    std::string text;
    for (int i = 0; i < 15; ++i) text += pieces[random() % std::size(pieces)];
    FileIndex index(text);
    for (int edit = 0; edit < 30; ++edit) {
      const size_t begin = random() % (text.size() + 1), most = std::min<size_t>(text.size() - begin, 20);
      const Span old{begin, begin + random() % (most + 1)};
      const std::string by = random() % 3 == 0 ? "" : pieces[random() % std::size(pieces)];
      const std::string before = text;
      text.replace(old.begin, old.size(), by);
      index.update(text, old, by.size());
      expect_same(index, FileIndex(text), before + "\n-----\n" + text);
      if (HasFailure()) return;
    }
  }
}

TEST(FileIndex, FindsWhatStandsAtAPlace) {
  const FileIndex index("WorldBegin\nNamedMaterial \"m\"\n");
  EXPECT_EQ(index.item_at(0), 0u);
  EXPECT_EQ(index.item_at(12), 1u);
  ASSERT_NE(index.mention_at(26), nullptr);
  EXPECT_EQ(index.mention_at(26)->name, "m");
  EXPECT_EQ(index.mention_at(12), nullptr);
  EXPECT_EQ(FileIndex("").item_at(0), 0u);
}

TEST(ValueSpans, AreThoseOfEachValue) {
  const std::string text = "Shape \"sphere\" \"rgb Kd\" [ 1 # one\n 2 3 ] \"string a\" \"b\"";
  Statement s;
  ASSERT_TRUE(read_at(text, 0, s));
  ASSERT_EQ(s.parameters.size(), 2u);
  const std::vector<Span> numbers = value_spans(text, s.parameters[0]);
  ASSERT_EQ(numbers.size(), 3u);
  EXPECT_EQ(text.substr(numbers[1].begin, numbers[1].size()), "2");
  const std::vector<Span> strings = value_spans(text, s.parameters[1]);
  ASSERT_EQ(strings.size(), 1u);
  EXPECT_EQ(text.substr(strings[0].begin, strings[0].size()), "\"b\"");
}

}  // namespace
}  // namespace whit::author
