fn main(){ println!("{}", std::any::type_name::<rustdds::DomainParticipant>()); }
