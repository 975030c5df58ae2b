// The parts that the grammar of a method is put together from, and how fields become arrays. Private to the grammar.
#pragma once

#include <cstring>
#include <string>
#include <vector>

#include "common/record/grammar.hpp"

namespace fracfarm::grammar {

std::vector<DatasetRow> phase_field_frames();  // grammar_phase_field.cpp
std::vector<DatasetRow> fdem_frames();         // grammar_fdem.cpp

std::vector<AttributeRow> shared_attributes();       // of every method; grammar_attributes.cpp
std::vector<AttributeRow> phase_field_attributes();  // beside them
std::vector<AttributeRow> fdem_attributes();

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

template <class T>
std::vector<T> values_of(const Array& array) {
  std::vector<T> values(array.bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), array.bytes.data(), values.size() * sizeof(T));
  return values;
}

// Frames of float fields of the extents `field`, one behind the other.
Array array_of_frames(const std::vector<std::vector<float>>& frames, std::vector<std::size_t> field);
std::vector<std::vector<float>> frames_of(const Array& array);

}  // namespace fracfarm::grammar
