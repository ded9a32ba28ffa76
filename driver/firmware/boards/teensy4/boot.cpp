#include <stdint.h>

// Data that the ROM of the i.MX RT1062 reads from the flash [S IMXRT1060RM revision 3, 9.6.3.1 and
// 9.7.1]. The flash is read with the plain command 03h at 30 MHz, which each serial flash has.

namespace {

struct FlashConfiguration {
  uint32_t tag, version, reserved0;
  uint8_t sample_clock, hold_time, setup_time, column_width;
  uint8_t unused1[0x44 - 0x10];
  uint8_t device_type, pad_type, clock, custom_sequence;
  uint8_t unused2[0x50 - 0x48];
  uint32_t size_a1, size_a2, size_b1, size_b2;
  uint8_t unused3[0x80 - 0x60];
  uint32_t sequences[64];
  uint8_t unused4[0x1c0 - 0x180];
  uint32_t page_size, sector_size;
  uint8_t command_clock, unused5[0x200 - 0x1c9];
};
static_assert(sizeof(FlashConfiguration) == 512, "the layout of the manual");

struct BootData {
  uint32_t start, length, plugin, reserved;
};

struct ImageVectorTable {
  uint32_t header;
  const void* entry;
  uint32_t reserved1, device_data;
  const BootData* boot_data;
  const ImageVectorTable* self;
  uint32_t signature, reserved2;
};

}  // namespace

extern "C" {
extern const struct Vectors vectors;
extern const ImageVectorTable image_vector_table;
extern const BootData boot_data;
extern const FlashConfiguration flash_configuration;
}

// The sequence 0 reads: command 03h, address of 24 bits, data, each on one line (27.5.9).
__attribute__((section(".flash_configuration"), used))
const FlashConfiguration flash_configuration = {0x42464346,
                                                0x56010000,
                                                0,
                                                0,
                                                3,
                                                3,
                                                0,
                                                {},
                                                1,
                                                1,
                                                1,
                                                0,
                                                {},
                                                0x200000,
                                                0,
                                                0,
                                                0,
                                                {},
                                                {0x08180403, 0x00002404},
                                                {},
                                                256,
                                                4096,
                                                1,
                                                {}};

__attribute__((section(".image_vector_table"), used)) const ImageVectorTable image_vector_table = {
    0x402000d1, &vectors, 0, 0, &boot_data, &image_vector_table, 0, 0};

__attribute__((section(".boot_data"), used))
const BootData boot_data = {0x60000000, 0x200000, 0, 0};
