#ifndef PARENT_H
#define PARENT_H

/*
 * Ties this program to the one that has started it, if that has put its process number into RKM04_PARENT: when it
 * ends, whatever ends it, this one is killed. Without the variable, and on other systems than Linux, nothing is tied.
 * On Windows the standard streams pass every byte as it is from then on. To be called once, first of all.
 */
void parent_bind(void);

#endif
