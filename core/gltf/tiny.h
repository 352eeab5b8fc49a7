// tinygltf, which makes typed data of a document's JSON. Only here is it included.
//
// It checks little and reads eagerly, so that it is given a document that has been checked, without buffers, pictures and
// accessors, and reads no file.
#pragma once

#include <tiny_gltf.h>

#include <memory>
#include <string>

#include "core/gltf/check.h"

namespace whit::gltf {

/// The name under which the result has KHR_draco_mesh_compression.
inline constexpr const char* kDracoShown = "draco";

/// Null when tinygltf refuses the document; `problem` says why.
std::unique_ptr<const tinygltf::Model> parse_typed(const Json& checked, std::string& problem);

/// The members of extensions.
const tinygltf::Value* member(const tinygltf::Value& object, const char* key);
const tinygltf::Value* member(const tinygltf::ExtensionMap& extensions, const char* key);
double number(const tinygltf::Value& object, const char* key, double otherwise);
int integer(const tinygltf::Value& object, const char* key, int otherwise);
std::vector<double> numbers(const tinygltf::Value& object, const char* key);
std::string text(const tinygltf::Value& object, const char* key);

}  // namespace whit::gltf
