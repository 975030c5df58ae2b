# Writes build_info.cpp: the digest of the numeric sources (names and bytes), the compiler and its flags.
file(STRINGS ${SOURCES} files)
list(SORT files)
set(text "${COMPILER}\n${FLAGS}\n")
foreach(file IN LISTS files)
  file(SHA256 ${file} digest)
  file(RELATIVE_PATH name ${ROOT} ${file})
  string(APPEND text "${name} ${digest}\n")
endforeach()
string(SHA256 digest "${text}")
string(SUBSTRING ${digest} 0 16 short)
file(WRITE ${OUT} "#include \"common/base/build_info.hpp\"

namespace fracfarm {

const BuildInfo& build_info() {
  static const BuildInfo info{\"${VERSION}\", \"${VERSION}-${short}\", \"${COMPILER}\", \"${FLAGS}\"};
  return info;
}

}  // namespace fracfarm
")
