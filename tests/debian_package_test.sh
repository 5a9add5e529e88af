#!/usr/bin/env bash
# cpack makes a Debian package that holds what it should and depends on what it needs. Argument: build folder.
set -euo pipefail
build=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
(cd "$build" && cpack -G DEB -B "$work") >"$work/log" 2>&1 || { cat "$work/log" >&2; exit 1; }
package=$(ls "$work"/*.deb)
dpkg-deb --contents "$package" | awk '{ print $6 }' | sed 's|^\.||' >"$work/files"
dpkg-deb --info "$package" >"$work/info"
cat "$work/files" "$work/info"
version=$(sed -n 's/^ Version: //p' "$work/info")
for file in /usr/bin/fastccd /usr/include/fastccd/fastccd.hpp /usr/include/fastccd/fastccd.h /usr/include/fastccd/adapters/ipc_toolkit.hpp \
  /usr/lib/libfastccd.a /usr/lib/libfastccd.so "/usr/lib/libfastccd.so.$version" /usr/lib/cmake/fastccd/fastccd-config.cmake \
  /usr/lib/pkgconfig/fastccd.pc /usr/share/doc/fastccd/copyright; do
  grep -qxF "$file" "$work/files" || { echo "FAILED: the package lacks $file" >&2; exit 1; }
done
grep -q '^ Depends: .*libtbb12' "$work/info" || { echo "FAILED: the package does not depend on oneTBB" >&2; exit 1; }
