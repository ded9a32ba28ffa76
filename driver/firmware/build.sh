#!/usr/bin/env bash
# Compiles and links the firmware for its targets, and prints the memory that each image uses.
#   driver/firmware/build.sh FOLDER [TARGET...]   default: all targets
# Images are written to FOLDER/TARGET.elf. Debian: gcc-arm-none-eabi picolibc-arm-none-eabi gcc-avr avr-libc.
set -euo pipefail
[ $# -gt 0 ] || { sed -n '2,5s/^# \{0,1\}//p' "$0"; exit 2; }
mkdir -p "$1"
out=$(cd "$1" && pwd)
shift
cd "$(dirname "$0")"
[ $# -gt 0 ] || set -- mps2_an385 stm32f405 rp2040 teensy4 hapkit_atmega328p

flags=(-std=c++14 -ffreestanding -ffunction-sections -fdata-sections -fno-exceptions -fno-rtti -fno-threadsafe-statics
  -Wall -Wextra -Wconversion -Werror -I. -Wl,--gc-sections)
arm=(arm-none-eabi-gcc -mthumb -O2 --specs=picolibc.specs -nostartfiles -Lboards/cortex_m boards/cortex_m/startup.cpp)
core=(core/controller.cpp core/packet.cpp core/run_loop.cpp boards/main.cpp)
usb=(boards/hid_link.cpp boards/usb_port.cpp usb/hid_device.cpp)

# link TARGET COMPILER FLAGS SOURCES...: compiles one image.
link() {
  local target=$1
  shift
  "$@" "${flags[@]}" "${core[@]}" -o "$out/$target.elf"
}

# memory TARGET SIZE FLASH RAM: prints the bytes of an image and those of the chip.
memory() {
  "$2" "$out/$1.elf" | awk -v target="$1" -v flash="$3" -v ram="$4" 'NR == 2 {
    printf "%-18s flash %6d of %8d bytes, RAM %6d of %7d bytes, without stack\n", target, $1 + $2, flash, $2 + $3, ram
    exit $1 + $2 > flash || $2 + $3 > ram }'
}

for target; do
  case $target in
    mps2_an385)
      link $target "${arm[@]}" -mcpu=cortex-m3 -T boards/mps2_an385/link.ld boards/plant_link.cpp boards/mps2_an385/board.cpp
      memory $target arm-none-eabi-size 4194304 4194304 ;;
    stm32f405)
      link $target "${arm[@]}" -mcpu=cortex-m4 -mfloat-abi=hard -mfpu=fpv4-sp-d16 -T boards/stm32f405/link.ld \
        boards/stm32f405/board.cpp "${usb[@]}" -Iboards/stm32f405
      memory $target arm-none-eabi-size 1048576 131072 ;;
    rp2040)
      link $target "${arm[@]}" -mcpu=cortex-m0plus -T boards/rp2040/link.ld boards/rp2040/boot2.S boards/rp2040/board.cpp \
        "${usb[@]}" -Iboards/rp2040
      memory $target arm-none-eabi-size 2097152 258048
      arm-none-eabi-objcopy -O binary "$out/$target.elf" "$out/$target.bin"
      python3 boards/rp2040/image.py "$out/$target.bin" "$out/$target.uf2" ;;
    teensy4)
      link $target "${arm[@]}" -mcpu=cortex-m7 -mfloat-abi=hard -mfpu=fpv5-d16 -T boards/teensy4/link.ld \
        boards/teensy4/boot.cpp boards/teensy4/board.cpp "${usb[@]}" -Iboards/teensy4
      memory $target arm-none-eabi-size 2023424 524288
      arm-none-eabi-objcopy -O ihex "$out/$target.elf" "$out/$target.hex" ;;
    hapkit_atmega328p)
      link $target avr-gcc -mmcu=atmega328p -O2 boards/hapkit_atmega328p/board.cpp
      memory $target avr-size 32768 2048 ;;
    *)
      echo "Unknown target '$target'. Targets: mps2_an385 stm32f405 rp2040 teensy4 hapkit_atmega328p." >&2
      exit 2 ;;
  esac
done
