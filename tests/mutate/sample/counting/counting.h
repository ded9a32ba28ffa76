#pragma once

int limited(int x, int max);
int counted(int n);
long length(const char* begin, const char* end);
int doubled(int x);
int tripled(int x);
