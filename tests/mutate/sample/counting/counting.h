#pragma once

int at_most(int x, int most);
int counted(int n);
long length(const char* begin, const char* end);
int doubled(int x);
int tripled(int x);
