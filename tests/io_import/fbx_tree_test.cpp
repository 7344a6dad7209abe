// The node tree of FBX files: text and binary give the same, and no byte of a damaged file is believed.
#include "io/import/fbx/fbx_tree.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include "baker/core/random.h"
#include "io/import/fbx/fbx_document.h"

namespace ft {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::byte*>(text.data()), text.size()};
}

template <class T>
void put(std::string& out, T value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string header(std::uint32_t version, char endian = 0) {
  std::string out("Kaydara FBX Binary  \0\x1a", 22);
  out += endian;
  put(out, version);
  return out;
}

/// A node of a binary file that begins at `at`; children are made for the place where they go.
struct Node {
  std::string name, properties;
  std::uint64_t property_count = 0;
  std::vector<Node> children;

  Node& number(std::int32_t value) {
    properties += 'I', put(properties, value), ++property_count;
    return *this;
  }
  Node& id(std::int64_t value) {
    properties += 'L', put(properties, value), ++property_count;
    return *this;
  }
  Node& text(const std::string& value) {
    properties += 'S', put(properties, static_cast<std::uint32_t>(value.size())), properties += value, ++property_count;
    return *this;
  }
  Node& doubles(const std::vector<double>& values, bool packed, std::uint32_t claimed) {
    std::string raw(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
    if (packed) {
      uLongf size = compressBound(raw.size());
      std::string out(size, '\0');
      compress(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(raw.data()), raw.size());
      raw = out.substr(0, size);
    }
    properties += 'd', put(properties, claimed), put(properties, std::uint32_t{packed});
    put(properties, static_cast<std::uint32_t>(raw.size())), properties += raw, ++property_count;
    return *this;
  }

  void write(std::string& file, bool wide) const {
    const auto word = [&](std::string& to, std::uint64_t v) {
      wide ? put(to, v) : put(to, static_cast<std::uint32_t>(v));
    };
    const std::size_t start = file.size();
    std::string head;
    word(head, 0), word(head, property_count), word(head, properties.size());
    head += static_cast<char>(name.size());
    file += head + name + properties;
    for (const Node& child : children) child.write(file, wide);
    if (!children.empty()) file.append(wide ? 25 : 13, '\0');
    std::string end;
    word(end, file.size());
    file.replace(start, end.size(), end);
  }
};

std::string binary_file(const std::vector<Node>& nodes, std::uint32_t version) {
  std::string out = header(version);
  for (const Node& node : nodes) node.write(out, version >= 7500);
  out.append(version >= 7500 ? 25 : 13, '\0');
  return out;
}

std::vector<Node> small_scene() {
  Node objects{"Objects", {}, 0, {}}, model{"Model", {}, 0, {}}, numbers{"Numbers", {}, 0, {}};
  numbers.doubles({1, 2.5, -3}, true, 3).doubles({4}, false, 1);
  model.id(77).text(std::string("hips\0\1Model", 11)).text("LimbNode");
  model.children.push_back(numbers);
  objects.children.push_back(model);
  return {objects};
}

const std::string k_text_scene =
    "; FBX 7.4.0 project file\n\nFBXHeaderExtension:  {\n\tFBXVersion: 7400\n}\n"
    "Objects:  {\n\tModel: 77, \"Model::hips\", \"LimbNode\" {\n\t\tNumbers: *4 {\n\t\t\ta: "
    "1,2.5,-3,\n4\n\t\t}\n\t}\n}\n";

TEST(FbxTree, Text_and_binary_of_both_widths_give_the_same_objects) {
  for (const std::string& file : {k_text_scene, binary_file(small_scene(), 7400), binary_file(small_scene(), 7700)}) {
    ASSERT_TRUE(is_fbx(bytes_of(file)));
    const auto document = FbxDocument::read(bytes_of(file));
    ASSERT_TRUE(document) << document.error().text();
    ASSERT_EQ(document->objects().size(), 1u);
    const FbxObject* model = document->object(77);
    ASSERT_NE(model, nullptr);
    EXPECT_EQ(model->name, "hips");
    EXPECT_EQ(model->subkind, "LimbNode");
    EXPECT_EQ(fbx_numbers(model->node->child("Numbers")), (std::vector<double>{1, 2.5, -3, 4}));
  }
}

TEST(FbxTree, Old_and_big_endian_files_are_refused_by_name_with_advice) {
  const auto refusal = [](const std::string& file) {
    EXPECT_TRUE(is_fbx(bytes_of(file)));
    const auto tree = read_fbx_tree(bytes_of(file));
    return tree ? std::string("read") : tree.error().text();
  };
  EXPECT_NE(refusal(header(6100)).find("FBX 6.1"), std::string::npos);
  EXPECT_NE(refusal(header(6100)).find("export it as FBX 7.4"), std::string::npos);
  EXPECT_NE(refusal("; FBX 6.1.0 project file\nObjects:  {\n}\n").find("FBX 6.1"), std::string::npos);
  EXPECT_NE(refusal("FBXHeaderExtension: {\n FBXVersion: 6100\n}\n").find("FBX 6.1"), std::string::npos);
  EXPECT_NE(refusal(header(7400, 1)).find("big-endian"), std::string::npos);
  EXPECT_FALSE(is_fbx(bytes_of("HIERARCHY\nROOT hips\n")));
  EXPECT_FALSE(is_fbx(bytes_of("")));
}

TEST(FbxTree, Files_cut_at_any_byte_are_refused) {
  for (const std::uint32_t version : {7400u, 7700u}) {
    const std::string file = binary_file(small_scene(), version);
    for (std::size_t size = 18; size < file.size(); ++size)
      EXPECT_FALSE(read_fbx_tree(bytes_of(file.substr(0, size)))) << size << " of " << file.size();
  }
  // A text may end behind any of its top nodes, and nobody can tell.
  const std::size_t objects = k_text_scene.find("Model: 77");
  for (std::size_t size = objects; size + 2 < k_text_scene.size(); ++size)
    EXPECT_FALSE(read_fbx_tree(bytes_of(k_text_scene.substr(0, size)))) << size;
}

TEST(FbxTree, No_size_is_believed_beyond_the_bytes_that_are_there) {
  for (const bool packed : {false, true}) {
    Node node{"Numbers", {}, 0, {}};
    node.doubles({1, 2, 3}, packed, 0xfffffff0u);
    const auto tree = read_fbx_tree(bytes_of(binary_file({node}, 7400)));
    ASSERT_FALSE(tree);
    EXPECT_NE(tree.error().what.find("Numbers"), std::string::npos) << tree.error().text();
  }
  const auto text = read_fbx_tree(bytes_of("; FBX 7.4.0\nNumbers: *4000000000 {\n a: 1,2\n}\n"));
  ASSERT_TRUE(text);
  EXPECT_EQ(fbx_numbers(text->root.child("Numbers")).size(), 2u);
}

TEST(FbxTree, Nodes_that_are_too_deep_are_refused) {
  std::string text = "; FBX 7.4.0\n";
  for (int k = 0; k < 100'000; ++k) text += "A: {\n";
  EXPECT_FALSE(read_fbx_tree(bytes_of(text)));
  Node deep{"A", {}, 0, {}};
  for (int k = 0; k < 200; ++k) deep = Node{"A", {}, 0, {deep}};
  EXPECT_FALSE(read_fbx_tree(bytes_of(binary_file({deep}, 7400))));
}

TEST(FbxTree, A_node_that_ends_behind_its_parent_is_refused) {
  // Read twice at each level, these are two million nodes.
  constexpr int k_pairs = 20;
  constexpr std::size_t k_head = 13 + 1;  // of a node without properties and a name of one letter
  std::string file = header(7400);
  const std::size_t size = file.size() + 2 * k_pairs * k_head;
  for (int pair = 0; pair < k_pairs; ++pair)
    for (const bool outer : {true, false}) {
      const std::size_t end = outer ? file.size() + 2 * k_head : size;
      put(file, static_cast<std::uint32_t>(end)), put(file, std::uint32_t{0}), put(file, std::uint32_t{0});
      file += '\1', file += outer ? 'a' : 'b';
    }
  ASSERT_EQ(file.size(), size);
  EXPECT_FALSE(read_fbx_tree(bytes_of(file)));
}

TEST(FbxTree, Any_byte_may_be_any_other) {
  // Ends in a tree or a named error; sanitizers see the rest.
  for (const std::string& good : {k_text_scene, binary_file(small_scene(), 7400), binary_file(small_scene(), 7700)})
    for (std::size_t at = 0; at < good.size(); ++at)
      for (const int value : {0, 1, 0x7f, 0x80, 0xff, int{'{'}, int{'"'}, int{'*'}, int{'-'}, int{'e'}}) {
        std::string file = good;
        file[at] = static_cast<char>(value);
        const auto document = FbxDocument::read(bytes_of(file));
        EXPECT_TRUE(document || !document.error().what.empty());
      }
}

TEST(FbxTree, Odd_numbers_of_text_files_are_read) {
  const auto tree = read_fbx_tree(
      bytes_of("; FBX 7.4.0\nA: *7 {\n a: 1e3,-0,+2,9223372036854775807,1.#INF,-inf,nan\n}\nB: T, Y, -1.5e-300\nC: , "
               "\"x&quot;y\"\n"));
  ASSERT_TRUE(tree) << tree.error().text();
  const auto a = fbx_numbers(tree->root.child("A"));
  ASSERT_EQ(a.size(), 7u);
  EXPECT_EQ(a[0], 1000);
  EXPECT_TRUE(a[1] == 0 && std::signbit(a[1]));
  EXPECT_EQ(a[2], 2);
  EXPECT_TRUE(std::isinf(a[4]) && a[4] > 0);
  EXPECT_TRUE(std::isinf(a[5]) && a[5] < 0);
  EXPECT_TRUE(std::isnan(a[6]));
  const FbxNode* b = tree->root.child("B");
  EXPECT_EQ(fbx_integer(*b, 0), 'T');
  EXPECT_EQ(fbx_number(*b, 2), -1.5e-300);
  EXPECT_EQ(fbx_text(*tree->root.child("C"), 0), "x\"y");
}

TEST(FbxDocument, Own_properties_come_before_those_of_the_definitions) {
  const auto document = FbxDocument::read(bytes_of(
      "; FBX 7.4.0\nDefinitions: {\n ObjectType: \"Model\" {\n  PropertyTemplate: \"FbxNode\" {\n   Properties70: {\n"
      "    P: \"Lcl Scaling\", \"Lcl Scaling\", \"\", \"A\",2,3,4\n    P: \"InheritType\", \"enum\", \"\", \"\",2\n   "
      "}\n"
      "  }\n }\n}\nObjects: {\n Model: 5, \"Model::a\", \"Null\" {\n  Properties70: {\n"
      "   P: \"InheritType\", \"enum\", \"\", \"\",1\n  }\n }\n Model: 5, \"Model::b\", \"Null\" {\n }\n"
      " Model: -6, \"Model::a\", \"Null\" {\n }\n}\nConnections: {\n C: \"OO\",-6,5\n C: \"OP\",-6,5, \"Look\"\n}\n"));
  ASSERT_TRUE(document) << document.error().text();
  const FbxObject* object = document->object(5);
  ASSERT_NE(object, nullptr);
  EXPECT_EQ(object->name, "a");  // the first of two with one id
  EXPECT_EQ(document->duplicate_count(), 1);
  EXPECT_EQ(object->vector("Lcl Scaling", Vec3::Zero()), Vec3(2, 3, 4));
  EXPECT_EQ(object->integer("InheritType", 0), 1);
  EXPECT_EQ(object->number("Missing", 0.25), 0.25);
  ASSERT_EQ(document->into(5).size(), 2u);
  EXPECT_EQ(document->into(5)[1].destination_property, "Look");
  EXPECT_EQ(document->members(5, "Model").size(), 1u);
  EXPECT_EQ(document->object(-6)->name, "a");  // told apart by the id alone
}

TEST(FbxDocument, Names_are_text_that_can_be_printed) {
  const auto document =
      FbxDocument::read(bytes_of("; FBX 7.4.0\nObjects: {\n Model: 5, \"Model::a\xff\xc3\xa9\x01\", "
                                 "\"Null\" {\n }\n}\n"));
  ASSERT_TRUE(document);
  EXPECT_EQ(document->object(5)->name, "a\xef\xbf\xbd\xc3\xa9\xef\xbf\xbd");
}

}  // namespace
}  // namespace ft
