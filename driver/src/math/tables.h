#pragma once

// Written by make_tables.py, which says where each number comes from.
// clang-format off

#include <cstdint>

#include "math/double_double.h"

namespace thimble::math {

/// sin(pi i / 64), a turn and a quarter: cos(pi i / 64) is the entry 32 further on.
inline constexpr DoubleDouble kSines[] = {
    {0, 0}, {0x1.91f65f10dd814p-5, -0x1.912bd0d569a9p-61},
    {0x1.917a6bc29b42cp-4, -0x1.e2718d26ed688p-60}, {0x1.2c8106e8e613ap-3, 0x1.13000a89a11ep-58},
    {0x1.8f8b83c69a60bp-3, -0x1.26d19b9ff8d82p-57}, {0x1.f19f97b215f1bp-3, -0x1.42deef11da2c4p-57},
    {0x1.294062ed59f06p-2, -0x1.5d28da2c4612dp-56}, {0x1.58f9a75ab1fddp-2, -0x1.efdc0d58cf62p-62},
    {0x1.87de2a6aea963p-2, -0x1.72cedd3d5a61p-57}, {0x1.b5d1009e15ccp-2, 0x1.5b362cb974183p-57},
    {0x1.e2b5d3806f63bp-2, 0x1.e0d891d3c6841p-58}, {0x1.073879922ffeep-1, -0x1.a5a014347406cp-55},
    {0x1.1c73b39ae68c8p-1, 0x1.b25dd267f66p-55}, {0x1.30ff7fce17035p-1, -0x1.efcc626f74a6fp-57},
    {0x1.44cf325091dd6p-1, 0x1.8076a2cfdc6b3p-57}, {0x1.57d69348cecap-1, -0x1.75720992bfbb2p-55},
    {0x1.6a09e667f3bcdp-1, -0x1.bdd3413b26456p-55}, {0x1.7b5df226aafafp-1, -0x1.0f537acdf0ad7p-56},
    {0x1.8bc806b151741p-1, -0x1.2c5e12ed1336dp-55}, {0x1.9b3e047f38741p-1, -0x1.30ee286712474p-55},
    {0x1.a9b66290ea1a3p-1, 0x1.9f630e8b6dac8p-60}, {0x1.b728345196e3ep-1, -0x1.bc69f324e6d61p-55},
    {0x1.c38b2f180bdb1p-1, -0x1.6e0b1757c8d07p-56}, {0x1.ced7af43cc773p-1, -0x1.e7b6bb5ab58aep-58},
    {0x1.d906bcf328d46p-1, 0x1.457e610231ac2p-56}, {0x1.e212104f686e5p-1, -0x1.014c76c126527p-55},
    {0x1.e9f4156c62ddap-1, 0x1.760b1e2e3f81ep-55}, {0x1.f0a7efb9230d7p-1, 0x1.52c7adc6b4989p-56},
    {0x1.f6297cff75cbp-1, 0x1.562172a361fd3p-56}, {0x1.fa7557f08a517p-1, -0x1.7a0a8ca13571fp-55},
    {0x1.fd88da3d12526p-1, -0x1.87df6378811c7p-55}, {0x1.ff621e3796d7ep-1, -0x1.c57bc2e24aa15p-57},
    {0x1p+0, 0}, {0x1.ff621e3796d7ep-1, -0x1.c57bc2e24aa15p-57},
    {0x1.fd88da3d12526p-1, -0x1.87df6378811c7p-55}, {0x1.fa7557f08a517p-1, -0x1.7a0a8ca13571fp-55},
    {0x1.f6297cff75cbp-1, 0x1.562172a361fd3p-56}, {0x1.f0a7efb9230d7p-1, 0x1.52c7adc6b4989p-56},
    {0x1.e9f4156c62ddap-1, 0x1.760b1e2e3f81ep-55}, {0x1.e212104f686e5p-1, -0x1.014c76c126527p-55},
    {0x1.d906bcf328d46p-1, 0x1.457e610231ac2p-56}, {0x1.ced7af43cc773p-1, -0x1.e7b6bb5ab58aep-58},
    {0x1.c38b2f180bdb1p-1, -0x1.6e0b1757c8d07p-56}, {0x1.b728345196e3ep-1, -0x1.bc69f324e6d61p-55},
    {0x1.a9b66290ea1a3p-1, 0x1.9f630e8b6dac8p-60}, {0x1.9b3e047f38741p-1, -0x1.30ee286712474p-55},
    {0x1.8bc806b151741p-1, -0x1.2c5e12ed1336dp-55}, {0x1.7b5df226aafafp-1, -0x1.0f537acdf0ad7p-56},
    {0x1.6a09e667f3bcdp-1, -0x1.bdd3413b26456p-55}, {0x1.57d69348cecap-1, -0x1.75720992bfbb2p-55},
    {0x1.44cf325091dd6p-1, 0x1.8076a2cfdc6b3p-57}, {0x1.30ff7fce17035p-1, -0x1.efcc626f74a6fp-57},
    {0x1.1c73b39ae68c8p-1, 0x1.b25dd267f66p-55}, {0x1.073879922ffeep-1, -0x1.a5a014347406cp-55},
    {0x1.e2b5d3806f63bp-2, 0x1.e0d891d3c6841p-58}, {0x1.b5d1009e15ccp-2, 0x1.5b362cb974183p-57},
    {0x1.87de2a6aea963p-2, -0x1.72cedd3d5a61p-57}, {0x1.58f9a75ab1fddp-2, -0x1.efdc0d58cf62p-62},
    {0x1.294062ed59f06p-2, -0x1.5d28da2c4612dp-56}, {0x1.f19f97b215f1bp-3, -0x1.42deef11da2c4p-57},
    {0x1.8f8b83c69a60bp-3, -0x1.26d19b9ff8d82p-57}, {0x1.2c8106e8e613ap-3, 0x1.13000a89a11ep-58},
    {0x1.917a6bc29b42cp-4, -0x1.e2718d26ed688p-60}, {0x1.91f65f10dd814p-5, -0x1.912bd0d569a9p-61},
    {0, 0}, {-0x1.91f65f10dd814p-5, 0x1.912bd0d569a9p-61},
    {-0x1.917a6bc29b42cp-4, 0x1.e2718d26ed688p-60}, {-0x1.2c8106e8e613ap-3, -0x1.13000a89a11ep-58},
    {-0x1.8f8b83c69a60bp-3, 0x1.26d19b9ff8d82p-57}, {-0x1.f19f97b215f1bp-3, 0x1.42deef11da2c4p-57},
    {-0x1.294062ed59f06p-2, 0x1.5d28da2c4612dp-56}, {-0x1.58f9a75ab1fddp-2, 0x1.efdc0d58cf62p-62},
    {-0x1.87de2a6aea963p-2, 0x1.72cedd3d5a61p-57}, {-0x1.b5d1009e15ccp-2, -0x1.5b362cb974183p-57},
    {-0x1.e2b5d3806f63bp-2, -0x1.e0d891d3c6841p-58}, {-0x1.073879922ffeep-1, 0x1.a5a014347406cp-55},
    {-0x1.1c73b39ae68c8p-1, -0x1.b25dd267f66p-55}, {-0x1.30ff7fce17035p-1, 0x1.efcc626f74a6fp-57},
    {-0x1.44cf325091dd6p-1, -0x1.8076a2cfdc6b3p-57}, {-0x1.57d69348cecap-1, 0x1.75720992bfbb2p-55},
    {-0x1.6a09e667f3bcdp-1, 0x1.bdd3413b26456p-55}, {-0x1.7b5df226aafafp-1, 0x1.0f537acdf0ad7p-56},
    {-0x1.8bc806b151741p-1, 0x1.2c5e12ed1336dp-55}, {-0x1.9b3e047f38741p-1, 0x1.30ee286712474p-55},
    {-0x1.a9b66290ea1a3p-1, -0x1.9f630e8b6dac8p-60}, {-0x1.b728345196e3ep-1, 0x1.bc69f324e6d61p-55},
    {-0x1.c38b2f180bdb1p-1, 0x1.6e0b1757c8d07p-56}, {-0x1.ced7af43cc773p-1, 0x1.e7b6bb5ab58aep-58},
    {-0x1.d906bcf328d46p-1, -0x1.457e610231ac2p-56}, {-0x1.e212104f686e5p-1, 0x1.014c76c126527p-55},
    {-0x1.e9f4156c62ddap-1, -0x1.760b1e2e3f81ep-55}, {-0x1.f0a7efb9230d7p-1, -0x1.52c7adc6b4989p-56},
    {-0x1.f6297cff75cbp-1, -0x1.562172a361fd3p-56}, {-0x1.fa7557f08a517p-1, 0x1.7a0a8ca13571fp-55},
    {-0x1.fd88da3d12526p-1, 0x1.87df6378811c7p-55}, {-0x1.ff621e3796d7ep-1, 0x1.c57bc2e24aa15p-57},
    {-0x1p+0, 0}, {-0x1.ff621e3796d7ep-1, 0x1.c57bc2e24aa15p-57},
    {-0x1.fd88da3d12526p-1, 0x1.87df6378811c7p-55}, {-0x1.fa7557f08a517p-1, 0x1.7a0a8ca13571fp-55},
    {-0x1.f6297cff75cbp-1, -0x1.562172a361fd3p-56}, {-0x1.f0a7efb9230d7p-1, -0x1.52c7adc6b4989p-56},
    {-0x1.e9f4156c62ddap-1, -0x1.760b1e2e3f81ep-55}, {-0x1.e212104f686e5p-1, 0x1.014c76c126527p-55},
    {-0x1.d906bcf328d46p-1, -0x1.457e610231ac2p-56}, {-0x1.ced7af43cc773p-1, 0x1.e7b6bb5ab58aep-58},
    {-0x1.c38b2f180bdb1p-1, 0x1.6e0b1757c8d07p-56}, {-0x1.b728345196e3ep-1, 0x1.bc69f324e6d61p-55},
    {-0x1.a9b66290ea1a3p-1, -0x1.9f630e8b6dac8p-60}, {-0x1.9b3e047f38741p-1, 0x1.30ee286712474p-55},
    {-0x1.8bc806b151741p-1, 0x1.2c5e12ed1336dp-55}, {-0x1.7b5df226aafafp-1, 0x1.0f537acdf0ad7p-56},
    {-0x1.6a09e667f3bcdp-1, 0x1.bdd3413b26456p-55}, {-0x1.57d69348cecap-1, 0x1.75720992bfbb2p-55},
    {-0x1.44cf325091dd6p-1, -0x1.8076a2cfdc6b3p-57}, {-0x1.30ff7fce17035p-1, 0x1.efcc626f74a6fp-57},
    {-0x1.1c73b39ae68c8p-1, -0x1.b25dd267f66p-55}, {-0x1.073879922ffeep-1, 0x1.a5a014347406cp-55},
    {-0x1.e2b5d3806f63bp-2, -0x1.e0d891d3c6841p-58}, {-0x1.b5d1009e15ccp-2, -0x1.5b362cb974183p-57},
    {-0x1.87de2a6aea963p-2, 0x1.72cedd3d5a61p-57}, {-0x1.58f9a75ab1fddp-2, 0x1.efdc0d58cf62p-62},
    {-0x1.294062ed59f06p-2, 0x1.5d28da2c4612dp-56}, {-0x1.f19f97b215f1bp-3, 0x1.42deef11da2c4p-57},
    {-0x1.8f8b83c69a60bp-3, 0x1.26d19b9ff8d82p-57}, {-0x1.2c8106e8e613ap-3, -0x1.13000a89a11ep-58},
    {-0x1.917a6bc29b42cp-4, 0x1.e2718d26ed688p-60}, {-0x1.91f65f10dd814p-5, 0x1.912bd0d569a9p-61},
    {0, 0}, {0x1.91f65f10dd814p-5, -0x1.912bd0d569a9p-61},
    {0x1.917a6bc29b42cp-4, -0x1.e2718d26ed688p-60}, {0x1.2c8106e8e613ap-3, 0x1.13000a89a11ep-58},
    {0x1.8f8b83c69a60bp-3, -0x1.26d19b9ff8d82p-57}, {0x1.f19f97b215f1bp-3, -0x1.42deef11da2c4p-57},
    {0x1.294062ed59f06p-2, -0x1.5d28da2c4612dp-56}, {0x1.58f9a75ab1fddp-2, -0x1.efdc0d58cf62p-62},
    {0x1.87de2a6aea963p-2, -0x1.72cedd3d5a61p-57}, {0x1.b5d1009e15ccp-2, 0x1.5b362cb974183p-57},
    {0x1.e2b5d3806f63bp-2, 0x1.e0d891d3c6841p-58}, {0x1.073879922ffeep-1, -0x1.a5a014347406cp-55},
    {0x1.1c73b39ae68c8p-1, 0x1.b25dd267f66p-55}, {0x1.30ff7fce17035p-1, -0x1.efcc626f74a6fp-57},
    {0x1.44cf325091dd6p-1, 0x1.8076a2cfdc6b3p-57}, {0x1.57d69348cecap-1, -0x1.75720992bfbb2p-55},
    {0x1.6a09e667f3bcdp-1, -0x1.bdd3413b26456p-55}, {0x1.7b5df226aafafp-1, -0x1.0f537acdf0ad7p-56},
    {0x1.8bc806b151741p-1, -0x1.2c5e12ed1336dp-55}, {0x1.9b3e047f38741p-1, -0x1.30ee286712474p-55},
    {0x1.a9b66290ea1a3p-1, 0x1.9f630e8b6dac8p-60}, {0x1.b728345196e3ep-1, -0x1.bc69f324e6d61p-55},
    {0x1.c38b2f180bdb1p-1, -0x1.6e0b1757c8d07p-56}, {0x1.ced7af43cc773p-1, -0x1.e7b6bb5ab58aep-58},
    {0x1.d906bcf328d46p-1, 0x1.457e610231ac2p-56}, {0x1.e212104f686e5p-1, -0x1.014c76c126527p-55},
    {0x1.e9f4156c62ddap-1, 0x1.760b1e2e3f81ep-55}, {0x1.f0a7efb9230d7p-1, 0x1.52c7adc6b4989p-56},
    {0x1.f6297cff75cbp-1, 0x1.562172a361fd3p-56}, {0x1.fa7557f08a517p-1, -0x1.7a0a8ca13571fp-55},
    {0x1.fd88da3d12526p-1, -0x1.87df6378811c7p-55}, {0x1.ff621e3796d7ep-1, -0x1.c57bc2e24aa15p-57},
};

/// 2^(i / 64).
inline constexpr DoubleDouble kPowers[] = {
    {0x1p+0, 0}, {0x1.02c9a3e778061p+0, -0x1.19083535b085dp-56},
    {0x1.059b0d3158574p+0, 0x1.d73e2a475b465p-55}, {0x1.0874518759bc8p+0, 0x1.186be4bb284ffp-57},
    {0x1.0b5586cf9890fp+0, 0x1.8a62e4adc610bp-54}, {0x1.0e3ec32d3d1a2p+0, 0x1.03a1727c57b53p-59},
    {0x1.11301d0125b51p+0, -0x1.6c51039449b3ap-54}, {0x1.1429aaea92dep+0, -0x1.32fbf9af1369ep-54},
    {0x1.172b83c7d517bp+0, -0x1.19041b9d78a76p-55}, {0x1.1a35beb6fcb75p+0, 0x1.e5b4c7b4968e4p-55},
    {0x1.1d4873168b9aap+0, 0x1.e016e00a2643cp-54}, {0x1.2063b88628cd6p+0, 0x1.dc775814a8495p-55},
    {0x1.2387a6e756238p+0, 0x1.9b07eb6c70573p-54}, {0x1.26b4565e27cddp+0, 0x1.2bd339940e9d9p-55},
    {0x1.29e9df51fdee1p+0, 0x1.612e8afad1255p-55}, {0x1.2d285a6e4030bp+0, 0x1.0024754db41d5p-54},
    {0x1.306fe0a31b715p+0, 0x1.6f46ad23182e4p-55}, {0x1.33c08b26416ffp+0, 0x1.32721843659a6p-54},
    {0x1.371a7373aa9cbp+0, -0x1.63aeabf42eae2p-54}, {0x1.3a7db34e59ff7p+0, -0x1.5e436d661f5e3p-56},
    {0x1.3dea64c123422p+0, 0x1.ada0911f09ebcp-55}, {0x1.4160a21f72e2ap+0, -0x1.ef3691c309278p-58},
    {0x1.44e086061892dp+0, 0x1.89b7a04ef80dp-59}, {0x1.486a2b5c13cdp+0, 0x1.3c1a3b69062fp-56},
    {0x1.4bfdad5362a27p+0, 0x1.d4397afec42e2p-56}, {0x1.4f9b2769d2ca7p+0, -0x1.4b309d25957e3p-54},
    {0x1.5342b569d4f82p+0, -0x1.07abe1db13cadp-55}, {0x1.56f4736b527dap+0, 0x1.9bb2c011d93adp-54},
    {0x1.5ab07dd485429p+0, 0x1.6324c054647adp-54}, {0x1.5e76f15ad2148p+0, 0x1.ba6f93080e65ep-54},
    {0x1.6247eb03a5585p+0, -0x1.383c17e40b497p-54}, {0x1.6623882552225p+0, -0x1.bb60987591c34p-54},
    {0x1.6a09e667f3bcdp+0, -0x1.bdd3413b26456p-54}, {0x1.6dfb23c651a2fp+0, -0x1.bbe3a683c88abp-57},
    {0x1.71f75e8ec5f74p+0, -0x1.16e4786887a99p-55}, {0x1.75feb564267c9p+0, -0x1.0245957316dd3p-54},
    {0x1.7a11473eb0187p+0, -0x1.41577ee04992fp-55}, {0x1.7e2f336cf4e62p+0, 0x1.05d02ba15797ep-56},
    {0x1.82589994cce13p+0, -0x1.d4c1dd41532d8p-54}, {0x1.868d99b4492edp+0, -0x1.fc6f89bd4f6bap-54},
    {0x1.8ace5422aa0dbp+0, 0x1.6e9f156864b27p-54}, {0x1.8f1ae99157736p+0, 0x1.5cc13a2e3976cp-55},
    {0x1.93737b0cdc5e5p+0, -0x1.75fc781b57ebcp-57}, {0x1.97d829fde4e5p+0, -0x1.d185b7c1b85d1p-54},
    {0x1.9c49182a3f09p+0, 0x1.c7c46b071f2bep-56}, {0x1.a0c667b5de565p+0, -0x1.359495d1cd533p-54},
    {0x1.a5503b23e255dp+0, -0x1.d2f6edb8d41e1p-54}, {0x1.a9e6b5579fdbfp+0, 0x1.0fac90ef7fd31p-54},
    {0x1.ae89f995ad3adp+0, 0x1.7a1cd345dcc81p-54}, {0x1.b33a2b84f15fbp+0, -0x1.2805e3084d708p-57},
    {0x1.b7f76f2fb5e47p+0, -0x1.5584f7e54ac3bp-56}, {0x1.bcc1e904bc1d2p+0, 0x1.23dd07a2d9e84p-55},
    {0x1.c199bdd85529cp+0, 0x1.11065895048ddp-55}, {0x1.c67f12e57d14bp+0, 0x1.2884dff483cadp-54},
    {0x1.cb720dcef9069p+0, 0x1.503cbd1e949dbp-56}, {0x1.d072d4a07897cp+0, -0x1.cbc3743797a9cp-54},
    {0x1.d5818dcfba487p+0, 0x1.2ed02d75b3707p-55}, {0x1.da9e603db3285p+0, 0x1.c2300696db532p-54},
    {0x1.dfc97337b9b5fp+0, -0x1.1a5cd4f184b5cp-54}, {0x1.e502ee78b3ff6p+0, 0x1.39e8980a9cc8fp-55},
    {0x1.ea4afa2a490dap+0, -0x1.e9c23179c2893p-54}, {0x1.efa1bee615a27p+0, 0x1.dc7f486a4b6bp-54},
    {0x1.f50765b6e454p+0, 0x1.9d3e12dd8a18bp-54}, {0x1.fa7c1819e90d8p+0, 0x1.74853f3a5931ep-55},
};

/// 1 / n!.
inline constexpr DoubleDouble kInverseFactorials[] = {
    {0x1p+0, 0}, {0x1p+0, 0},
    {0x1p-1, 0}, {0x1.5555555555555p-3, 0x1.5555555555555p-57},
    {0x1.5555555555555p-5, 0x1.5555555555555p-59}, {0x1.1111111111111p-7, 0x1.1111111111111p-63},
    {0x1.6c16c16c16c17p-10, -0x1.f49f49f49f49fp-65}, {0x1.a01a01a01a01ap-13, 0x1.a01a01a01a01ap-73},
    {0x1.a01a01a01a01ap-16, 0x1.a01a01a01a01ap-76}, {0x1.71de3a556c734p-19, -0x1.c154f8ddc6cp-73},
    {0x1.27e4fb7789f5cp-22, 0x1.cbbc05b4fa99ap-76}, {0x1.ae64567f544e4p-26, -0x1.c062e06d1f209p-80},
    {0x1.1eed8eff8d898p-29, -0x1.2aec959e14c06p-83}, {0x1.6124613a86d09p-33, 0x1.f28e0cc748ebep-87},
    {0x1.93974a8c07c9dp-37, 0x1.05d6f8a2efd1fp-92}, {0x1.ae7f3e733b81fp-41, 0x1.1d8656b0ee8cbp-97},
    {0x1.ae7f3e733b81fp-45, 0x1.1d8656b0ee8cbp-101}, {0x1.952c77030ad4ap-49, 0x1.ac981465ddc6cp-103},
    {0x1.6827863b97d97p-53, 0x1.eec01221a8b0bp-107}, {0x1.2f49b46814157p-57, 0x1.2650f61dbdcb4p-112},
    {0x1.e542ba4020225p-62, 0x1.ea72b4afe3c2fp-120},
};

/// 1 / (2 n + 1).
inline constexpr DoubleDouble kOddInverses[] = {
    {0x1p+0, 0}, {0x1.5555555555555p-2, 0x1.5555555555555p-56},
    {0x1.999999999999ap-3, -0x1.999999999999ap-57}, {0x1.2492492492492p-3, 0x1.2492492492492p-57},
    {0x1.c71c71c71c71cp-4, 0x1.c71c71c71c71cp-58}, {0x1.745d1745d1746p-4, -0x1.745d1745d1746p-59},
    {0x1.3b13b13b13b14p-4, -0x1.3b13b13b13b14p-58}, {0x1.1111111111111p-4, 0x1.1111111111111p-60},
    {0x1.e1e1e1e1e1e1ep-5, 0x1.e1e1e1e1e1e1ep-61}, {0x1.af286bca1af28p-5, 0x1.af286bca1af28p-59},
    {0x1.8618618618618p-5, 0x1.8618618618618p-59}, {0x1.642c8590b2164p-5, 0x1.642c8590b2164p-60},
};

/// pi / 64 in parts of 28 bits, whose products with 25 bits are exact.
inline constexpr double kSineStep[] = {
    0x1.921fb54p-5, 0x1.10b461p-35,
    0x1.a62633p-63, 0x1.45c06ep-91,
    0x1.cd12902p-120, 0x1.3822298p-150,
    0x1.f31d0082efa99p-178,
};

/// ln(2) / 64 in parts of 35 bits, whose products with 18 bits are exact.
inline constexpr double kPowerStep[] = {
    0x1.62e42fef8p-7, 0x1.1cf79abc8p-42,
    0x1.e3b39803cp-78, 0x1.97b57a079a193p-113,
};

/// atan(i / 8).
inline constexpr double kArcs[] = {
    0, 0x1.fd5ba9aac2f6ep-4,
    0x1.f5b75f92c80ddp-3, 0x1.6f61941e4def1p-2,
    0x1.dac670561bb4fp-2, 0x1.1e00babdefeb4p-1,
    0x1.4978fa3269ee1p-1, 0x1.700a7c5784634p-1,
    0x1.921fb54442d18p-1,
};

/// 1 / (2 pi): 64 zeros, and 1280 bits behind the point.
inline constexpr std::uint64_t kPerTurn[] = {
    0x0000000000000000, 0x28be60db9391054a,
    0x7f09d5f47d4d3770, 0x36d8a5664f10e410,
    0x7f9458eaf7aef158, 0x6dc91b8e909374b8,
    0x01924bba82746487, 0x3f877ac72c4a69cf,
    0xba208d7d4baed121, 0x3a671c09ad17df90,
    0x4e64758e60d4ce7d, 0x272117e2ef7e4a0e,
    0xc7fe25fff7816603, 0xfbcbc462d6829b47,
    0xdb4d9fb3c9f2c26d, 0xd3d18fd9a797fa8b,
    0x5d49eeb1faf97c5e, 0xcf41ce7de294a4ba,
    0x9afed7ec47e35742, 0x1580cc11bf1edaea,
    0xfc33ef0826bd0d87,
};

/// pi.
inline constexpr DoubleDouble kPi{0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};

/// pi / 2.
inline constexpr DoubleDouble kHalfPi{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};

/// 2 pi.
inline constexpr DoubleDouble kTwoPi{0x1.921fb54442d18p+2, 0x1.1a62633145c07p-52};

/// ln(2).
inline constexpr DoubleDouble kLn2{0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56};

}  // namespace thimble::math
