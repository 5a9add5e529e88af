#!/usr/bin/env bash
# emulated_avx512.sh WORK PROGRAMS FILE...: runs the kernels for AVX-512 where the machine has none. WORK is a folder for what is made and
# kept, PROGRAMS one with the tests' programs, and each FILE is put beside them. Commands are read from standard input, one a line.
#
# qemu 7.2 and valgrind 3.19 emulate no AVX-512. Bochs does, but only whole machines: so a kernel of Debian's is started in it, whose first file
# system holds the programs and the libraries that they need. Some 40 s until it runs, and floating-point arithmetic about
# 400 times as slow as here. It may take FASTCCD_EMULATION_SECONDS, 900 unless told otherwise.
source "$(dirname "$0")/../tools/setup.sh"
work=$1 programs=$2
shift 2
mapfile -t commands
install_packages "${emulator_packages[@]}"
system=$work/system disc=$work/disc serial=$work/serial.txt
rm -rf "$system" "$disc" "$serial" "$work/keys"
mkdir -p "$system"/{bin,dev,proc} "$disc"

if ! compgen -G "$work/boot/vmlinuz-*" >/dev/null; then
  # Unpacked, not installed: that would set up this machine's own start. Lists of packages from long ago name files that are gone.
  download_kernel() {
    local package
    package=$(apt-cache depends linux-image-cloud-amd64 | sed -n 's/^ *Depends: \(linux-image-[^ ]*\)$/\1/p')
    (cd "$work" && apt-get download -qq -o APT::Sandbox::User=root "$package")
  }
  download_kernel || { as_root apt-get update -qq && download_kernel; }
  dpkg-deb --fsys-tarfile "$work"/linux-image-*.deb | tar -x -C "$work" --wildcards './boot/vmlinuz-*'
  rm "$work"/linux-image-*.deb
fi
cp "$work"/boot/vmlinuz-* "$disc/vmlinuz"

cp /bin/busybox "$system/bin"
cp "$@" "$system"
for command in "${commands[@]}"; do
  program=$programs/${command%% *}
  cp "$program" "$system"
  ldd "$program" | grep -o '/[^ ]*' | while read -r library; do install -D "$library" "$system$library"; done
done
# All functions are bound when a program starts: to bind one at its first call the dynamic linker saves registers in the compacted format, and
# Bochs 2.7 faults where it restores some of them.
{
  echo '#!/bin/busybox sh'
  echo '/bin/busybox --install /bin; mount -t proc proc /proc; mount -t devtmpfs dev /dev; export GTEST_COLOR=no LD_BIND_NOW=1; failed=0'
  echo 'for wanted in avx512f avx512cd avx512dq avx512bw; do grep -qw $wanted /proc/cpuinfo || { echo "the emulated processor lacks $wanted"; failed=1; }; done'
  for command in "${commands[@]}"; do
    printf 'echo %q; set -o pipefail; ./%s || { echo "exit $?"; failed=1; }\n' "$command" "$command"
  done
  echo '[ $failed = 0 ] && echo "everything passed"; sleep 1; poweroff -f'  # a second for what is under way to the serial port
} >"$system/init"
chmod +x "$system/init"
(cd "$system" && find . | cpio -o -H newc --quiet) >"$disc/system"

# Bochs 2.7 tells the size of the standard format of registers saved where the kernel asks for that of the compacted one; the kernel
# would take that for a fault and leave AVX alone.
cat >"$disc/isolinux.cfg" <<'EOF'
DEFAULT tests
LABEL tests
 KERNEL /vmlinuz
 INITRD /system
 APPEND console=ttyS0 quiet mitigations=off clearcpuid=xsavec,xsaves
EOF
cp /usr/lib/ISOLINUX/isolinux.bin /usr/lib/syslinux/modules/bios/ldlinux.c32 "$disc"
xorriso -as mkisofs -quiet -o "$work/disc.iso" -b isolinux.bin -c boot.cat -no-emul-boot -boot-load-size 4 -boot-info-table "$disc" 2>/dev/null

# Debian's Bochs waits in its debugger until it is told to continue, and wants a terminal.
echo continue >"$work/debugger"
# Opened to be read and written, it never ends: at the end of its input, script would press Ctrl-D.
mkfifo "$work/keys"
exec {keys}<>"$work/keys"

machine=
show_serial() { [ ! -f "$serial" ] || tr -d '\r' <"$serial"; }
# What was printed is not lost; and what is started beside a script is deaf to Ctrl-C, so it is told to end.
trap '[ -z "$machine" ] || kill "$machine" 2>/dev/null || true; show_serial; exit 143' HUP INT TERM

# run_machine TIME: nothing outside decides what happens in it. Its clock begins at TIME, in seconds from 1970, and counts instructions, the
# screen's does too, and no key is pressed. A panic of Bochs ends it, as nobody is there to be asked. 124 or, where it had to be
# killed, 137 if it takes more than $seconds.
run_machine() {
  local status=0
  cat >"$work/bochsrc" <<EOF
display_library: term
cpu: model=corei7_skylake_x, ips=100000000
clock: sync=none, time0=$1
vga: extension=vbe, update_freq=5, realtime=0
panic: action=fatal
memory: guest=512, host=512
romimage: file=/usr/share/bochs/BIOS-bochs-latest
vgaromimage: file=/usr/share/bochs/VGABIOS-lgpl-latest
ata0-master: type=cdrom, path="$work/disc.iso", status=inserted
boot: cdrom
com1: enabled=1, mode=file, dev="$serial"
sound: waveoutdrv=dummy, waveindrv=dummy, midioutdrv=dummy
log: "$work/bochs.log"
EOF
  rm -f "$serial"
  timeout --kill-after=10 "$seconds" script -qec "TERM=linux bochs -q -rc '$work/debugger' -f '$work/bochsrc'" /dev/null \
    >"$work/screen" 2>&1 <&"$keys" &
  machine=$!
  wait "$machine" || status=$?
  show_serial
  return "$status"
}
seconds=${FASTCCD_EMULATION_SECONDS:-900} status=0
run_machine 1704067200 || status=$?
if [ "$status" -eq 124 ] || [ "$status" -eq 137 ]; then
  # Seen once, when the clock still was the host's, and what had been printed was lost.
  echo "the emulated machine did not end within $seconds s; what it had printed is above. Once more, from another time." >&2
  run_machine 1706745600 || true
fi
# A filter that fits no test is no test passed.
! grep -q '] 0 tests' "$serial" && grep -q '^everything passed' "$serial" || { echo "failed in the emulated machine; what it printed is in $serial" >&2; exit 1; }
