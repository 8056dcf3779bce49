#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include "formats/merl/merl.h"
#include "formats/rgl/rgl.h"
#include "sqt/aligned.h"
#include "sqt/errors.h"
using namespace suite; using namespace suite::sqt;
double now(){return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();}
int main(int argc,char**argv){
  std::string path=argv[1]; std::shared_ptr<const Function> f;
  if(path.find(".bsdf")!=std::string::npos) f=read_rgl(path); else f=read_merl(path);
  double t0=now();
  AlignedSource::Options o; if(argc>2) o.views=atoi(argv[2]); if(argc>3) o.detail=atof(argv[3]); if(argc>4) o.base_order=atoi(argv[4]);
  AlignedSource src(*f,o); double t1=now();
  Reference ref(*f,200000); double t2=now();
  printf("source %.2fs reference %.2fs maxtotal %.3f recip %.3f\n",t1-t0,t2-t1,ref.findings().largest_total,ref.findings().reciprocity_error);
  for(double q: {0.02,0.04,0.08,0.16,0.32,0.64,1.28}){
    t0=now(); std::vector<AlignedSheet> d; auto bytes=encode_sheets(src,q,&d); t1=now();
    AlignedData data; data.function=src.function(); data.layout=src.layout(); data.layout.quality=q; data.totals=src.totals();
    auto dec=decode_sheets(data.layout,bytes); t2=now();
    bool same=dec[0].plane==d[0].plane&&dec[0].leaves==d[0].leaves;
    data.sheets=dec; data.totals.log2_scale=fit_scale(data.layout,d,data.totals,data.function.wavelength_um); double t3=now();
    auto b=make_bundle(data); double t4=now();
    auto e=ref.measure(*b).back(); double t5=now();
    printf("q %.3f bytes %zu leaves %zu ord %d same %d l1 %.4f cosrmse %.4f rmse %.4g peak %.3f %.3f %.3f tot %.4f rec %.4f maxw %.2f | enc %.2f dec %.4f scale %.2f tab %.4f meas %.2f\n",q,bytes.size(),b->info().leaves,b->info().max_order,same,e.l1,e.cos_rmse,e.rmse,e.peak_ratio_20,e.peak_ratio_45,e.peak_ratio_70,e.total_error,e.reciprocity_error,e.max_weight,t1-t0,t2-t1,t3-t2,t4-t3,t5-t4);
    fflush(stdout);
  }
}
