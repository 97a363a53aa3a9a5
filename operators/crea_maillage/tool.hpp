#pragma once
// crea_maillage without an order: cuts the slave skins of a MED file, for Lacon or for any other solver.

namespace lacon {

/// `crea_maillage IN.med OUT.med --slave GROUP ...`: reads, cuts, writes; nothing is written where anything fails. Beside the
/// errors of reading, cutting and writing: CUT_1 where the two files are one. @return exit status
int cut_med_file(int argc, char** argv);

}  // namespace lacon
