use ikcore::robot::*; use ikcore::math::pose; use ikcore::nalgebra::Vector3;
use std::time::Instant; use std::hint::black_box;
fn main(){
  let mut b=ChainBuilder::new("iiwa","base");
  let ax=[Vector3::z(),Vector3::y(),Vector3::z(),-Vector3::y(),Vector3::z(),Vector3::y(),Vector3::z()];
  let off=[0.,0.36,0.,0.42,0.,0.40,0.];
  for i in 0..7 { let j=b.add_joint(Joint::new(format!("j{i}"),JointKind::Revolute)); b.fixed(pose::translation(0.,0.,off[i])); b.moving(j,JointKind::Revolute,ax[i],Drive::DIRECT);}
  b.fixed(pose::translation(0.,0.,0.126)); b.link("tip");
  let r=b.build().unwrap();
  println!("{:?}", r.tip_position(&[0.1,0.2,0.3,0.4,0.5,0.6,0.7]));
  println!("{:?}", r.fk(&[0.1,0.2,0.3,0.4,0.5,0.6,0.7]).unwrap().translation);
  let mut q=[0.1,0.2,0.3,0.4,0.5,0.6,0.7];
  let n=5_000_000;
  for _ in 0..2 {
  let t=Instant::now(); let mut s=0.0; for i in 0..n { q[0]=i as f64*1e-7; s+=black_box(r.tip(black_box(&q))).origin[0]; } println!("fk {:.1} ns {s}", t.elapsed().as_nanos() as f64/n as f64);
  let t=Instant::now(); let mut s=0.0; for i in 0..n { q[0]=i as f64*1e-7; s+=black_box(r.tip_position(black_box(&q)))[0]; } println!("pos {:.1} ns {s}", t.elapsed().as_nanos() as f64/n as f64);
  let mut c=[[0.0;6];MAX_DOF];
  let t=Instant::now(); let mut s=0.0; for i in 0..n { q[0]=i as f64*1e-7; s+=black_box(r.tip_and_jacobian(black_box(&q),&mut c)).origin[0]; } println!("jac {:.1} ns {s}", t.elapsed().as_nanos() as f64/n as f64);
  }
}
