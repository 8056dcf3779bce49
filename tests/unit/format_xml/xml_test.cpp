// XML as a tree whose parts know their places.
#include "formats/xml/xml.h"

#include <gtest/gtest.h>

namespace suite::format_xml_xml_test {

namespace {

TEST(Xml, TextsAttributesAndPlaces) {
  const XmlElement root = XmlElement::parse(
      "<?xml version='1.0'?>\n<a k='1' l=\"2\">\n  <b> x <!-- no --><![CDATA[<y>]]> </b>\n  <b/>\n</a>", "t.xml");
  EXPECT_EQ(root.name(), "a");
  EXPECT_EQ(root.attribute("l"), "2");
  EXPECT_FALSE(root.attribute("m"));
  EXPECT_EQ(root.where().line, 2);
  std::vector<std::string> texts;
  std::vector<int> lines;
  root.each_child("b", [&](const XmlElement& b) { texts.push_back(b.text()), lines.push_back(b.where().line); });
  EXPECT_EQ(texts, (std::vector<std::string>{"x <y>", ""}));
  EXPECT_EQ(lines, (std::vector<int>{3, 4}));
}

int line_of_fault(const std::string& text) {
  try {
    XmlElement::parse(text, "t.xml");
  } catch (const Error& e) {
    EXPECT_EQ(e.where().file, "t.xml");
    return e.where().line;
  }
  return -1;
}

TEST(Xml, FaultsAreLocated) {
  EXPECT_EQ(line_of_fault("<a>\n<b>\n</a>"), 3);
  EXPECT_EQ(line_of_fault("<a>\n\xff</a>"), 2);
  EXPECT_EQ(line_of_fault(""), 1);
  std::string deep;
  for (int i = 0; i < 300; ++i) deep += "<a>\n";
  EXPECT_EQ(line_of_fault(deep), 201);
}

}  // namespace

}  // namespace suite::format_xml_xml_test
