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
libraries=$(dirname "$(grep '/libfastccd\.a$' "$work/files")")  # /usr/lib, or that of the architecture
for file in /usr/bin/fastccd /usr/include/fastccd/fastccd.hpp /usr/include/fastccd/fastccd.h /usr/include/fastccd/adapters/ipc_toolkit.hpp \
  "$libraries/libfastccd.so" "$libraries/libfastccd.so.$version" "$libraries/cmake/fastccd/fastccd-config.cmake" \
  "$libraries/pkgconfig/fastccd.pc" /usr/share/doc/fastccd/copyright; do
  grep -qxF "$file" "$work/files" || { echo "FAILED: the package lacks $file" >&2; exit 1; }
done
grep -q '^ Depends: .*libtbb12' "$work/info" || { echo "FAILED: the package does not depend on oneTBB" >&2; exit 1; }
